// SPDX-License-Identifier: MIT
#include "support/machine/stopwatch.h"

#include <sys/resource.h>

namespace cairn::cli {

ThreadTime ThreadStopwatch::Now() {
  return {.cpu = cli::Now(SolverClock::kThreadCpu), .wall = cli::Now(SolverClock::kWall)};
}

long ThreadStopwatch::Preemptions() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

ThreadTime ThreadStopwatch::Read() const {
  // first what takes no time to read itself
  const double wall = cli::Now(SolverClock::kWall), cpu = cli::Now(SolverClock::kThreadCpu);
  return {.cpu = cpu - start_.cpu,
          .wall = wall - start_.wall,
          .preempted = Preemptions() != preemptions_};
}

std::vector<double> Undisturbed(std::span<const double> values,
                                const std::vector<bool>& preempted) {
  std::vector<double> calm;
  for (size_t i = 0; i < values.size(); ++i) {
    if (!preempted[i]) calm.push_back(values[i]);
  }
  return 4 * calm.size() < values.size() ? std::vector<double>(values.begin(), values.end()) : calm;
}

}  // namespace cairn::cli
