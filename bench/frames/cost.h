// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "frames/size_series.h"

namespace cairn::frames {

/// What a row costs in a sweep, and what the begin and the end of a frame cost beside ten sweeps.
void PrintCosts(const SeriesOptions& options, const std::string& command);

}  // namespace cairn::frames
