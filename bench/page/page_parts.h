// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace cairn::cli {

/// Style sheet of the page: bench/page/style.css.
std::string_view PageStyle();

/// The scripts of bench/page with uPlot and three.js, whose licences are inside. Empty where the
/// tool was built without Node.
std::string_view PageScript();

}  // namespace cairn::cli
