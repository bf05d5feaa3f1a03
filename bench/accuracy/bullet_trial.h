// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "cairn/contact_problem.h"
#include "measure/contact_frame.h"
#include "measure/substep.h"

namespace cairn::accuracy {

/// Where the time of a solver of Bullet's went, CPU time of the thread [ms].
struct BulletTime {
  double set_up = 0;      ///< From contacts and joints to rows.
  double split = 0;       ///< Pushing bodies apart, which changes no velocity.
  double iterations = 0;  ///< What Cairn's core replaces.
  double finish = 0;      ///< Back into bodies, contacts and joints.

  double total() const { return set_up + split + iterations + finish; }
};

/// A substep as rows, and where its bodies were.
struct RecordedSubstep {
  struct Start {
    const btRigidBody* body = nullptr;  ///< None for what does not move.
    Velocity velocity;                  ///< That of the body, and what forces add to it.
  };

  bench::ContactFrame frame;  ///< With impulses as Bullet's warm start leaves them.
  std::vector<Start> starts;  ///< One per body of the frame.

  /// What the solver that wrote the bodies last changed, one per body of the frame; they are
  /// floats.
  std::vector<Velocity> Changes() const;
};

/// Bullet's stock solver, btSequentialImpulseConstraintSolver, on a captured substep.
class BulletTrial {
 public:
  BulletTrial();
  ~BulletTrial();

  /// Solves the substep once, from its captured state. All groups are one.
  BulletTime Solve(const bench::Substep& substep, const btContactSolverInfo& info, int iterations);
  /// By a Solve() of its own. Without rows if nothing touches.
  RecordedSubstep Record(const bench::Substep& substep, const btContactSolverInfo& info);

  /// Velocity changes of the warm start, which is iteration 0, and after each iteration from 1 on;
  /// false ends it.
  using Follower = std::function<bool(int iteration, std::span<const Velocity> velocities)>;
  /// Solves the substep with at most that many iterations, and shows them.
  void Follow(const bench::Substep& substep, const btContactSolverInfo& info, int most,
              Follower follower);

 private:
  class Solver;

  std::unique_ptr<Solver> solver_;
};

}  // namespace cairn::accuracy
