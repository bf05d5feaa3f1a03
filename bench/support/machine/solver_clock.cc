// SPDX-License-Identifier: MIT
#include "support/machine/solver_clock.h"

#include <ctime>

namespace cairn::cli {

double Now(SolverClock clock) {
  timespec time{};
  clock_gettime(clock == SolverClock::kThreadCpu ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC,
                &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace cairn::cli
