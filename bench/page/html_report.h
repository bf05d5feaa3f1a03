// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run/result.h"

namespace cairn::cli {

/// The result as one page that needs nothing else: no network, no other file. Light, dark and on
/// paper. Its scripts are in it; where the tool was built without them, it has its tables and one
/// still picture of each scene.
std::string ToHtml(const RunResult& run);

/// What the solvers were given, in numbers.
std::string ProblemCard(const SceneResult& scene);

/// How the run was made, on what, and how far to trust it.
std::string MethodBox(const RunResult& run);

/// What the scripts of the page draw, as JSON that may stand inside a script element.
std::string PageData(const RunResult& run);

/// The motion of a scene with every solver, small enough for a page: of `bytes` or less in base64.
///
/// Every k-th frame is kept. A pose is six 16-bit numbers: the position within a box around the
/// scene (bodies outside of it are moved to its edge), and x, y, z of a unit quaternion whose w is
/// not negative. An error is one byte, logarithmic from 0.1 mm to 1 m.
nlohmann::ordered_json PackAnimation(const SceneResult& scene, size_t bytes);

}  // namespace cairn::cli
