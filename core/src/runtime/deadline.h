// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

#include "cairn/tuning.h"

namespace cairn {

/// What a clock says; nullptr: std::chrono::steady_clock.
inline std::chrono::nanoseconds ReadClock(const Clock* clock) {
  if (clock != nullptr) return clock->Now();
  return std::chrono::steady_clock::now().time_since_epoch();
}

/// When work that may be left undone is to be left. Threads other than the one that made it do not
/// read the clock, and hear from that one.
class Deadline {
 public:
  /// Never.
  Deadline() = default;
  Deadline(const Clock* clock, std::chrono::nanoseconds end)
      : limited_(true), clock_(clock), end_(end), owner_(std::this_thread::get_id()) {}

  /// Looks at the clock. Once passed, it stays so.
  bool Pass() {
    if (!limited_) return false;
    if (passed()) return true;
    if (std::this_thread::get_id() != owner_ || ReadClock(clock_) < end_) return false;
    passed_.store(true, std::memory_order_relaxed);
    return true;
  }
  bool passed() const { return passed_.load(std::memory_order_relaxed); }

 private:
  bool limited_ = false;
  const Clock* clock_ = nullptr;
  std::chrono::nanoseconds end_{0};
  std::thread::id owner_;
  std::atomic<bool> passed_{false};
};

/// Deadline::Pass(), never without one.
inline bool Passes(Deadline* deadline) { return deadline != nullptr && deadline->Pass(); }

/// The same before part @p i of many that take less than a microsecond: not each is worth a look.
inline bool Passes(Deadline* deadline, int i) {
  constexpr int kUnseen = 16;
  return i % kUnseen == 0 && Passes(deadline);
}

}  // namespace cairn
