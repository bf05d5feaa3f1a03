// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "accuracy/velocity_norm.h"
#include "cairn/settings.h"
#include "frames/frame_solver.h"
#include "rigid/contact_frame.h"

namespace cairn::accuracy {

enum class Kind { kSweeps, kSteps };  ///< Without subspace steps, and with them.

/// What Cairn did with a state in a time, over several rounds: medians where nothing else is said.
struct CairnResult {
  VelocityDistance error;  ///< rms and max each for itself
  double least_rms = 0, most_rms = 0;
  double residual_max = 0;   ///< As reported [m/s].
  double cpu = 0, wall = 0;  ///< Of Solve() [ms].
  double sweeps = 0;
  double accepted = 0, restored = 0, factorisations = 0;  ///< Mean per Solve().
  int rounds = 0;
  int preempted = 0;         ///< Rounds that were interrupted each time they were tried.
  std::optional<int> worth;  ///< Iterations of Bullet until its rms is no larger, if it got there.
};

/// cairn::Solver with a time, on frames that were recorded.
class CairnTrial {
 public:
  explicit CairnTrial(Kind kind);

  /// Each Solve() follows one of the frame before, as in a game: what changes from frame to frame
  /// has its cost, and what the solver learnt there helps. An interrupted one is made again.
  /// @param before  may be without rows
  /// @param budget  [ms]
  void Round(const bench::ContactFrame& before, const bench::ContactFrame& frame, double budget);
  /// Of the last Round().
  const std::vector<Velocity>& velocities() const { return solver_.velocities(); }
  void Keep(const VelocityDistance& error);
  /// Of all kept since the last call.
  CairnResult Take();

 private:
  frames::FrameSolver solver_;
  frames::SolveTime time_;
  std::vector<double> rms_, max_, residual_, cpu_, wall_, sweeps_;
  CairnResult sums_;
};

/// CPU time of a Solve() that neither sweeps nor steps: reading rows and writing results [ms].
double SolveFloor(const bench::ContactFrame& before, const bench::ContactFrame& frame, int rounds);

}  // namespace cairn::accuracy
