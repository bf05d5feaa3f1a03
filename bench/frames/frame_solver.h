// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "cairn/report.h"
#include "cairn/settings.h"
#include "cairn/solver.h"
#include "measure/contact_frame.h"
#include "support/machine/stopwatch.h"

namespace cairn::frames {

/// A solver with the memory that it writes to, so that only Solve() itself is timed.
class FrameSolver {
 public:
  explicit FrameSolver(const Settings& settings) : solver_(settings) {}

  /// Solves from the warm start of the frame. @throws std::runtime_error if it is refused.
  cli::ThreadTime Solve(const bench::ContactFrame& frame);

  Settings& settings() { return solver_.settings(); }
  const Report& report() const { return report_; }
  const std::vector<double>& impulses() const { return impulses_; }
  const std::vector<Velocity>& velocities() const { return velocities_; }

 private:
  Solver solver_;
  Report report_;
  std::vector<double> impulses_;
  std::vector<Velocity> velocities_;
};

}  // namespace cairn::frames
