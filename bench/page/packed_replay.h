// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "run/result.h"

namespace cairn::cli {

/// The motion of a scene with every solver, small enough for a page: of `bytes` or less in base64.
///
/// Every k-th frame is kept. A pose is six 16-bit numbers: the position within a box around the
/// scene (bodies outside of it are moved to its edge), and x, y, z of a unit quaternion whose w is
/// not negative. An error is one byte, logarithmic from 0.1 mm to 1 m.
nlohmann::ordered_json PackReplay(const SceneResult& scene, size_t bytes);

}  // namespace cairn::cli
