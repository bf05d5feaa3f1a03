// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>
#include <cairn/bullet/constraint_solver.h>

#include <array>

#include "cairn/settings.h"
#include "measure/substep.h"
#include "support/machine/stopwatch.h"

namespace cairn::accuracy {

/// How Cairn solves: plain sweeps, sweeps that build on each other, and those with subspace steps,
/// which is what it does unless told otherwise.
enum class Kind { kSweeps, kAccelerated, kSteps };
inline constexpr std::array kKinds = {Kind::kSweeps, Kind::kAccelerated, Kind::kSteps};
/// "sweeps", "accelerated", "steps"
const char* NameOf(Kind kind);
/// Nothing but the budget ends a Solve() with these.
Settings SettingsOf(Kind kind);

/// What a shadow did with a substep.
struct ShadowFrame {
  double budget = 0;                         ///< [ms]
  cli::ThreadTime time;                      ///< From prepareSolve() to the end of allSolved().
  double build = 0, solve = 0, write = 0;    ///< SubstepTimes [ms].
  double step_predicted = 0, step_time = 0;  ///< As reported [ms].
  double residual_max = 0;                   ///< As reported [m/s].
  int sweeps = 0, factorisations = 0, accepted = 0, restored = 0;
  bool empty = false;  ///< Nothing touched.

  int steps() const { return accepted + restored; }
};

/// cairn::bullet::ConstraintSolver beside another solver: it is given each substep of a world that
/// the other one drives, and learns from frame to frame what it would learn in its place. Contacts
/// start from the impulses of the world, joints from those of its own last substep. They stay as
/// hard as the world says, whatever their age: both solve the same.
class Shadow {
 public:
  explicit Shadow(const Settings& settings)
      : solver_(settings, {.resting_slop = false, .two_friction_directions = false}) {}

  /// Solves the substep from its captured state; the bodies keep what comes out.
  /// @param budget  [ms]
  /// @throws std::runtime_error if Cairn refuses it, or leaves it to Bullet
  ShadowFrame Solve(const bench::Substep& substep, const btContactSolverInfo& info, double budget);

 private:
  ShadowFrame Describe() const;

  bullet::ConstraintSolver solver_;
  bench::JointImpulses joints_;
};

}  // namespace cairn::accuracy
