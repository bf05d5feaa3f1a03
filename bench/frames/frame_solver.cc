// SPDX-License-Identifier: MIT
#include "frames/frame_solver.h"

#include <sys/resource.h>

#include <ctime>
#include <stdexcept>
#include <string>

namespace cairn::frames {
namespace {

double Microseconds(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
}

long Preemptions() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

}  // namespace

SolveTime FrameSolver::Solve(const bench::ContactFrame& frame) {
  impulses_.assign(frame.impulses.begin(), frame.impulses.end());
  velocities_.resize(frame.bodies.size());
  const long preemptions = Preemptions();
  const double cpu = Microseconds(CLOCK_THREAD_CPUTIME_ID);
  const double wall = Microseconds(CLOCK_MONOTONIC);
  solver_.Solve(frame.problem(), impulses_, velocities_, &report_);
  SolveTime time;
  time.wall_us = Microseconds(CLOCK_MONOTONIC) - wall;
  time.cpu_us = Microseconds(CLOCK_THREAD_CPUTIME_ID) - cpu;
  time.preempted = Preemptions() != preemptions;
  if (!report_.ok()) throw std::runtime_error(std::string(Describe(report_.status)));
  return time;
}

Settings Sweeps(int count, int threads) {
  Settings settings;
  settings.method = Method::kPgs;
  settings.max_sweeps = count;
  settings.tolerance = 0;
  settings.tuning.min_progress = 0;
  settings.threads = threads;
  return settings;
}

}  // namespace cairn::frames
