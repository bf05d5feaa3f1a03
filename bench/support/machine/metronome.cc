// SPDX-License-Identifier: MIT
#include "support/machine/metronome.h"

#include <chrono>

#include "support/duration.h"

namespace cairn::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kChain = 10'000;
/// 8 MB: more than the caches that a core has for itself.
constexpr std::uint32_t kValues = 1 << 21;
constexpr int kVisits = 1 << 10;  // Few: what solvers left in the caches should stay there.

/// Keeps the compiler from leaving out how `value` came about.
void Use(double value) {
  volatile double sink = value;
  static_cast<void>(sink);
}

}  // namespace

double TimeChain(int length) {
  const Clock::time_point begin = Clock::now();
  volatile double start = 0.5;  // volatile: the compiler knows how the chain ends
  double value = start;
  for (int i = 0; i < length; ++i) value = value * 0.999999 + 1e-6;
  Use(value);
  return Milliseconds(Clock::now() - begin);
}

Metronome::Metronome() : values_(kValues, 0.5f) {}

Metronome::Beat Metronome::Strike() {
  const double arithmetic = TimeChain(kChain);
  const Clock::time_point begin = Clock::now();
  float sum = 0;
  for (int i = 0; i < kVisits; ++i) {
    state_ = state_ * 1664525u + 1013904223u;
    sum += values_[state_ >> 11];
  }
  Use(sum);
  return {.arithmetic = arithmetic, .memory = Milliseconds(Clock::now() - begin)};
}

}  // namespace cairn::cli
