// SPDX-License-Identifier: MIT
#include "accuracy/thread_stopwatch.h"

#include <sys/resource.h>

#include "contestants/solver_clock.h"

namespace cairn::accuracy {

ThreadTime ThreadStopwatch::Now() {
  return {.cpu = cli::Now(cli::SolverClock::kThreadCpu), .wall = cli::Now(cli::SolverClock::kWall)};
}

long ThreadStopwatch::Preemptions() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

ThreadTime ThreadStopwatch::Read() const {
  const ThreadTime end = Now();
  return {.cpu = end.cpu - start_.cpu,
          .wall = end.wall - start_.wall,
          .preempted = Preemptions() != preemptions_};
}

}  // namespace cairn::accuracy
