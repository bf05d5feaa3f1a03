// SPDX-License-Identifier: MIT
// Clocks for Tuning::clock: what they say does not depend on the machine.
#pragma once

#include <chrono>
#include <functional>
#include <utility>

#include "cairn/tuning.h"
#include "tests/core/support/problems.h"

namespace cairn::test {

/// Goes on by what a function says of each look, the first one being number 0.
class ScriptedClock final : public Clock {
 public:
  using Step = std::function<std::chrono::nanoseconds(int look)>;

  explicit ScriptedClock(Step step) : step_(std::move(step)) {}

  std::chrono::nanoseconds Now() const override { return time_ += step_(looks_++); }
  int looks() const { return looks_; }

 private:
  Step step_;
  mutable int looks_ = 0;
  mutable std::chrono::nanoseconds time_{1'000'000'000};
};

/// As much for every look.
inline ScriptedClock TickingClock(std::chrono::nanoseconds tick) {
  return ScriptedClock([tick](int) { return tick; });
}

/// From nothing to twice as much for every look, at random.
inline ScriptedClock UnsteadyClock(std::chrono::nanoseconds tick, std::uint64_t seed) {
  return ScriptedClock([tick, random = Random(seed)](int) mutable {
    return std::chrono::nanoseconds(random.Index(2 * static_cast<int>(tick.count()) + 1));
  });
}

}  // namespace cairn::test
