// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <utility>

#include "cairn/lcp/solver.h"

namespace cairn::cli {

using PhaseName = std::pair<const char*, std::chrono::nanoseconds lcp::Phases::*>;

/// The phases of a solve and what tables call them.
inline constexpr std::array<PhaseName, 7> kPhases = {{{"layout", &lcp::Phases::layout},
                                                      {"sweeps", &lcp::Phases::sweeps},
                                                      {"ordering", &lcp::Phases::ordering},
                                                      {"analysis", &lcp::Phases::analysis},
                                                      {"factorising", &lcp::Phases::factorisation},
                                                      {"solving", &lcp::Phases::solves},
                                                      {"other", &lcp::Phases::other}}};

}  // namespace cairn::cli
