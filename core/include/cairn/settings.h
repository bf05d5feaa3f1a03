// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include "cairn/budget.h"
#include "cairn/executor.h"
#include "cairn/report.h"
#include "cairn/tuning.h"

namespace cairn {

/// How the iterations are made.
enum class Method {
  kPgs,    ///< Projected Gauss-Seidel: sweeps only, each from the impulses of the last.
  kPsor,   ///< The same with over-relaxation Tuning::omega.
  kPgsSm,  ///< Accelerated sweeps, and subspace minimisation steps where they pay.
};

/// How hard to try; the defaults are meant for a game. Plain data: Solve() refuses what is out of
/// range (Status::kBadSettings) and names the first in Report::bad_setting.
///
/// What few touch is in Tuning, but for six promised names: method, k_gs, k_sm, acceleration,
/// step_policy, proximal_joints.
struct Settings {
  Method method = Method::kPgsSm;
  Path path = Path::kAuto;  ///< Which code. Report::path says which it was.
  int k_gs = 5;  ///< Sweeps before each subspace step, and again after it, >= 1; 2 are too few.
  /// Factorisations in one subspace step at most, in [0, 1000]: one, and one more for each pass
  /// that removes rows which left their bounds. 0: no steps.
  int k_sm = 2;
  bool steps = true;  ///< Off: no subspace steps, as with k_sm = 0.
  /// Sweeps in one Solve() at most, >= 0; but see StepPolicy::kWeighed. At 0 the start comes back.
  int max_sweeps = 1000;
  int substeps = 1;  ///< Parts of a step, in [1, 64], see docs/solver.md; 1 with Tuning::replay.
  /// What takes back errors of position moves bodies (Solver::mean_velocities()) and leaves them no
  /// velocity: docs/solver.md, Relaxation. Off with Tuning::replay.
  bool relax = false;
  /// Joints hold heavy loads at ContactProblem::time_step, if that is above 0: docs/solver.md.
  bool geometric_stiffness = true;
  /// Done when no row is further from its law than this: natural residual, in [m/s] for rows that
  /// act on points and in [rad/s] for rows that only turn, >= 0. 0 means never; Path::kAuto takes
  /// double precision below 1e-5.
  double tolerance = 1e-4;
  Budget budget = Budget::Unlimited();
  /// Threads of one Solve(), the caller's included, in [1, 1024]; the same bits for any number.
  int threads = 1;
  /// Where the other threads come from; nullptr: oneTBB, or std::thread where built without. Must
  /// outlive every Solve().
  Executor* executor = nullptr;

  Acceleration acceleration = Acceleration::kNncg;
  StepPolicy step_policy = StepPolicy::kMeasured;
  /// Proximal term of a step on rows without bounds (joints), relative to the diagonal of the row,
  /// in [1e-12, 1]. What that does to redundant joints: docs/solver.md, Guards.
  double proximal_joints = 1e-6;

  Tuning tuning = {};
};

/// What Path::kAuto comes to under these settings: kFast or kReference.
Path PathOf(const Settings& settings);

/// The first setting that is out of its range, if any.
[[nodiscard]] BadSetting FindBadSetting(const Settings& settings);

}  // namespace cairn
