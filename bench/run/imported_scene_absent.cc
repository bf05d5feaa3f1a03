// SPDX-License-Identifier: MIT
#include "run/imported_scene.h"
#include "support/failure.h"

namespace cairn::cli {

SceneChoice ImportScene(const std::string&, std::uint64_t) {
  throw Failure(kBadInput,
                "--import needs Bullet's importer, and this program was built without it (Debian: "
                "libbullet-extras-dev)");
}

}  // namespace cairn::cli
