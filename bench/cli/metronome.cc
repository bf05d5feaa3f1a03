// SPDX-License-Identifier: MIT
#include "cli/metronome.h"

#include <chrono>

#include "cli/duration.h"

namespace cairn::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kChain = 10'000;
constexpr int kValues = 1 << 16;
constexpr int kVisits = 1 << 14;

}  // namespace

double TimeChain(int length) {
  const Clock::time_point begin = Clock::now();
  volatile double start = 0.5, sink = 0;  // volatile: the compiler knows how the chain ends
  double value = start;
  for (int i = 0; i < length; ++i) value = value * 0.999999 + 1e-6;
  sink = value;
  static_cast<void>(sink);
  return Milliseconds(Clock::now() - begin);
}

Metronome::Metronome() : values_(kValues, 0.5f), order_(kVisits) {
  unsigned state = 1;
  for (int& place : order_) {
    state = state * 1664525u + 1013904223u;
    place = static_cast<int>(state >> 16) % (kValues - 4);
  }
}

double Metronome::Beat() {
  const double chain = TimeChain(kChain);
  const Clock::time_point begin = Clock::now();
  for (const int place : order_) {
    float* const v = &values_[place];
    const float sum = v[0] * 0.25f + v[1] * 0.25f + v[2] * 0.25f + v[3] * 0.25f;
    for (int i = 0; i < 4; ++i) v[i] += 0.1f * (sum - v[i]);
  }
  return chain + Milliseconds(Clock::now() - begin);
}

}  // namespace cairn::cli
