// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

namespace cairn::cli {

/// Finds, frame by frame, how many iterations of a solver without a clock fit into a budget: what
/// users do by hand, at its best.
class IterationFit {
 public:
  explicit IterationFit(std::chrono::nanoseconds budget) : budget_(budget) {}

  int iterations() const { return iterations_; }
  /// Learns what a frame with iterations() iterations took.
  void Learn(std::chrono::nanoseconds time) {
    const double used = static_cast<double>(std::max<std::int64_t>(1, time.count()));
    const double left = kAim * static_cast<double>(budget_.count()) - used;
    // Set-up is in `used`, so an iteration costs less than this: steps up are cautious, and steps
    // down are repeated until they have done enough.
    const double per_iteration = used / iterations_;
    const double next = iterations_ + left / per_iteration;
    iterations_ = static_cast<int>(
        std::clamp(std::floor(next), 1.0, std::min<double>(2.0 * iterations_, kMost)));
  }

 private:
  static constexpr double kAim = 0.9;  // of the budget: frames differ, and above it is an overrun
  static constexpr int kMost = 10000;

  std::chrono::nanoseconds budget_;
  int iterations_ = 10;
};

}  // namespace cairn::cli
