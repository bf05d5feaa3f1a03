// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "run/result.h"

namespace cairn::cli {

/// How much the times of the metronome differed, in half a sentence.
std::string DescribeBeats(const RunResult& run);

/// How noisy the machine was during the run: of the metronome, whose work is always the same, and
/// of each solver from repetition to repetition.
std::string NoiseText(const RunResult& run);

}  // namespace cairn::cli
