// SPDX-License-Identifier: MIT
#include "frames/frame_solver.h"

#include <stdexcept>
#include <string>

namespace cairn::frames {

cli::ThreadTime FrameSolver::Solve(const bench::ContactFrame& frame) {
  impulses_.assign(frame.impulses.begin(), frame.impulses.end());
  velocities_.resize(frame.bodies.size());
  const cli::ThreadStopwatch stopwatch;
  solver_.Solve(frame.problem(), impulses_, velocities_, &report_);
  const cli::ThreadTime time = stopwatch.Read();
  if (!report_.ok()) throw std::runtime_error(std::string(Describe(report_.status)));
  return time;
}

}  // namespace cairn::frames
