// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <utility>

#include "cairn/report.h"

namespace cairn::cli {

using PhaseName = std::pair<const char*, std::chrono::nanoseconds Phases::*>;

/// The phases of a solve and what tables call them.
inline constexpr std::array<PhaseName, 7> kPhases = {{{"layout", &Phases::layout},
                                                      {"sweeps", &Phases::sweeps},
                                                      {"ordering", &Phases::ordering},
                                                      {"analysis", &Phases::analysis},
                                                      {"factorising", &Phases::factorisation},
                                                      {"solving", &Phases::solves},
                                                      {"other", &Phases::other}}};

}  // namespace cairn::cli
