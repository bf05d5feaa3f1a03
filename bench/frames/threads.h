// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "frames/size_series.h"

namespace cairn::frames {

/// Wall time of solves of ten sweeps with one thread and with two.
void PrintThreads(const SeriesOptions& options, const std::string& command);

}  // namespace cairn::frames
