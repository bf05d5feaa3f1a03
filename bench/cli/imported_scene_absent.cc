// SPDX-License-Identifier: MIT
#include "cli/failure.h"
#include "cli/imported_scene.h"

namespace cairn::cli {

SceneChoice ImportScene(const std::string&, std::uint64_t) {
  throw Failure(kBadInput,
                "--import needs Bullet's importer, and this program was built without it (Debian: "
                "libbullet-extras-dev)");
}

}  // namespace cairn::cli
