// SPDX-License-Identifier: MIT
#include "effort/iteration_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace cairn::cli {
namespace {

constexpr double kAim = 0.9;  // of the budget: frames differ, and above it is an overrun
constexpr int kMost = 10000;

}  // namespace

void IterationFit::Learn(std::chrono::nanoseconds time) {
  const double used = static_cast<double>(std::max<std::int64_t>(1, time.count()));
  const double left = kAim * static_cast<double>(budget_.count()) - used;
  // Set-up is in `used`, so an iteration costs less than this: steps up are cautious, and steps
  // down are repeated until they have done enough.
  const double per_iteration = used / iterations_;
  const double next = iterations_ + left / per_iteration;
  iterations_ = static_cast<int>(
      std::clamp(std::floor(next), 1.0, std::min<double>(2.0 * iterations_, kMost)));
}

}  // namespace cairn::cli
