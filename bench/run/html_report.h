// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "run/result.h"

namespace cairn::cli {

/// The result as one page that needs nothing else: no network, no script, no font. Light, dark and
/// on paper.
std::string ToHtml(const RunResult& run);

}  // namespace cairn::cli
