// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "run/result.h"

namespace cairn::cli {

/// One line per scene, solver and frame under one line of names. What was not measured is empty.
std::string ToCsv(const RunResult& run);

}  // namespace cairn::cli
