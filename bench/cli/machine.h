// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace cairn::cli {

/// How much the same work differs from one time to the next on this machine now.
struct Noise {
  int repetitions = 0;
  double median = 0;           ///< [ms]
  double p99_over_median = 0;  ///< 1 on a perfect machine.
  /// Differences of medians above this can be trusted [%], at least 1: the spread from the 10th to
  /// the 90th percentile.
  double threshold = 0;
  std::string verdict;  ///< One sentence.
};

/// Repeats about 2 ms of arithmetic for as long as asked.
Noise MeasureNoise(std::chrono::milliseconds duration);

/// Where and with what a run was made. Empty texts where the system does not say.
struct Machine {
  std::string cpu;
  int cores = 0;
  std::string governor;      ///< CPU frequency governor.
  std::string load_average;  ///< "0.12 0.30 0.25": 1, 5 and 15 minutes.
};

Machine DescribeMachine();

}  // namespace cairn::cli
