// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

#include "cairn/lcp/solver.h"

namespace cairn::lcp {

/// Adds the time from its construction to its destruction to a phase. Reads no clock without one.
class PhaseClock {
 public:
  explicit PhaseClock(std::chrono::nanoseconds* phase) : phase_(phase) {
    if (phase_ != nullptr) start_ = Clock::now();
  }
  ~PhaseClock() {
    if (phase_ != nullptr) *phase_ += Clock::now() - start_;
  }
  PhaseClock(const PhaseClock&) = delete;
  PhaseClock& operator=(const PhaseClock&) = delete;

 private:
  using Clock = std::chrono::steady_clock;

  std::chrono::nanoseconds* phase_;
  Clock::time_point start_;
};

}  // namespace cairn::lcp
