// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "run/result.h"

namespace cairn::cli {

/// The result as one page that needs nothing else: no network, no other file. Light, dark and on
/// paper. Its scripts are in it; where the tool was built without them, it has still pictures.
std::string ToHtml(const RunResult& run);

}  // namespace cairn::cli
