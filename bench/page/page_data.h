// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "run/result.h"

namespace cairn::cli {

/// What the scripts of the page draw, as JSON that may stand inside a script element.
std::string PageData(const RunResult& run);

}  // namespace cairn::cli
