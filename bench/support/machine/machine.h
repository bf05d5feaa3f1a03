// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

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

/// A cache of the first core.
struct Cache {
  std::string type;  ///< "Data", "Instruction" or "Unified".
  int level = 0;
  std::int64_t bytes = 0;
  int cores = 0;  ///< That share it.
};

/// Where and with what a run was made. Empty texts where the system does not say.
struct Machine {
  std::string cpu;
  int cores = 0;
  int megahertz = 0;  ///< As the system says, 0 if it does not.
  std::vector<Cache> caches;
  std::string governor;      ///< CPU frequency governor.
  std::string load_average;  ///< "0.12 0.30 0.25": 1, 5 and 15 minutes.
};

Machine DescribeMachine();

}  // namespace cairn::cli
