// SPDX-License-Identifier: MIT
#pragma once

#include <cairn/bullet/constraint_solver.h>

#include <memory>
#include <vector>

#include "contestants/contestant.h"
#include "measure/substep.h"
#include "run/scene_run.h"
#include "small/small.h"

namespace cairn::cli {

/// A world that Bullet drives with many iterations, whose substeps all are given to every solver,
/// ten iterations each: contacts start from the impulses of the world, joints from those of the
/// solver's own last substep, and what a solver learns it keeps, as in a game. Velocities are
/// compared with those of a converged reference, which solves Bullet's problem: without the
/// inertia that Cairn adds to bodies whose joints pull too hard for the time step.
class SameStates {
 public:
  SameStates(const SceneChoice& scene, const Setup& setup);

  /// Makes a step.
  void Step() { Step(nullptr); }
  /// Makes a step, and adds the errors of all solvers in it to a result.
  void Measure(SmallResult* result) { Step(result); }

 private:
  struct Shadow {
    std::unique_ptr<Contestant> contestant;
    btContactSolverInfo info;  ///< Stays where it is: Cairn knows a world again by it.
    bench::JointImpulses joints;
  };

  void Step(SmallResult* result);
  std::vector<Velocity> Solve(const bench::Substep& substep, const btContactSolverInfo& info,
                              Shadow* shadow);

  StateRun run_;
  std::vector<std::unique_ptr<Shadow>> shadows_;  ///< One for each of SmallSolvers().
  bullet::ConstraintSolver reference_;
};

}  // namespace cairn::cli
