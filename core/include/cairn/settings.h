// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/detail/cpp20.h"

#include "cairn/budget.h"
#include "cairn/executor.h"
#include "cairn/report.h"
#include "cairn/spans.h"

namespace cairn {

/// How the iterations are made.
enum class Method {
  kPgs,    ///< Projected Gauss-Seidel: sweeps only.
  kPsor,   ///< The same with over-relaxation Settings::omega.
  kPgsSm,  ///< Sweeps and subspace minimisation steps.
};

/// The order in which rows are swept.
enum class SweepOrder {
  /// kColoured, unless Settings::tolerance is too fine for floats (positive and below 1e-5).
  kAutomatic,
  /// Row 0 first, in double precision, on one thread.
  kForward,
  kReverse,    ///< As kForward.
  kSymmetric,  ///< As kForward.
  /// Colour by colour: what has one colour shares no body, and threads relax it side by side. Same
  /// bits for any number of threads. All rows of two bodies together, joints before contacts, in
  /// floats with vector instructions; the same bits for any of those. What
  /// floats cannot hold is left to kForward: a start or 1 / d beyond 1e12, say. See docs/solver.md.
  kColoured,
};

/// When a subspace step is taken (Method::kPgsSm with k_sm > 0 only).
enum class StepPolicy {
  kMeasured,  ///< Where it is predicted to pay, and no longer where it was measured not to.
  kAlways,    ///< After every k_gs sweeps that may be followed by k_gs more, at any cost.
  /// Where it lowers the energy by more than the sweeps in its place would, and is predicted to
  /// cost about as much as all else on its island at most. Islands without a step go on for up to
  /// twice max_sweeps; docs/solver.md, Effort. Contact problems in blocks without a budget;
  /// elsewhere as kMeasured.
  kWeighed,
};

/// What a friction row does while its parent row pushes with nothing.
enum class LiftedFriction {
  kRelease,  ///< Its impulse is zero, as Coulomb says.
  kHold,     ///< It keeps its last impulse, as Bullet's sequential impulses do.
};

/// Whether sweeps build on each other.
enum class Acceleration {
  kNone,
  /// Nonsmooth nonlinear conjugate gradients (Silcowitz-Niebe and Erleben 2010): before a sweep the
  /// state moves on along what the last ones changed. One such sweep is worth several, see
  /// docs/benchmarks.md.
  kNncg,
};

/// How hard to try. Plain data; Solve() rejects values out of range (Status::kBadSettings), and
/// Report::bad_setting names the first.
struct Settings {
  Method method = Method::kPgsSm;
  SweepOrder order = SweepOrder::kAutomatic;

  /// Sweeps before each subspace step, and again after it, >= 1. Five are enough to smooth what the
  /// step leaves behind; two are not.
  int k_gs = 5;
  /// Factorisations in one subspace step at most, in [0, 1000]: one, and one more for each pass
  /// that removes rows which left their bounds. 0: no steps.
  int k_sm = 2;
  /// Sweeps in one Solve() at most, >= 0; but see StepPolicy::kWeighed.
  int max_sweeps = 1000;
  /// Solve() is done when no row is further from its law than this: natural residual, in [m/s] for
  /// rows that act on points and in [rad/s] for rows that only turn, >= 0; 0 means never.
  double tolerance = 1e-3;
  /// Solve() is also done when a whole sweep moved no row by more than this, [m/s] or [rad/s],
  /// >= 0. At 0 only a sweep that changed nothing at all ends the iteration.
  double min_progress = 0;
  Budget budget = Budget::Unlimited();
  /// A frame to be made again: its work instead of the budget, its answers instead of the clock's.
  /// nullptr: none. Must outlive the Solve().
  const Replay* replay = nullptr;
  /// Sweeps made even if the budget is spent before them, >= 0. At 0 a budget that is too small for
  /// anything returns the warm start.
  int min_sweeps = 1;
  /// Threads that may work on one Solve(), the caller included, in [1, 1024]. Results are the same
  /// for any number. Problems too small to gain stay on the caller's.
  int threads = 1;
  /// Where the other threads come from; nullptr: oneTBB. Must outlive every Solve().
  Executor* executor = nullptr;
  /// Takes down which thread did what when, on contact problems in blocks (SweepOrder::kColoured);
  /// nullptr: nobody does. Must outlive every Solve(). No result depends on it.
  SpanRecorder* spans = nullptr;

  /// Over-relaxation of Method::kPsor, in (0, 2). 1 is Gauss-Seidel.
  double omega = 1;
  LiftedFriction lifted_friction = LiftedFriction::kRelease;
  /// Of sweeps of Method::kPgsSm in a contact problem that is swept in colours; elsewhere sweeps
  /// are what their names say.
  Acceleration acceleration = Acceleration::kNncg;

  StepPolicy step_policy = StepPolicy::kMeasured;
  /// Proximal term of a subspace step on rows with bounds, relative to the diagonal of the row,
  /// in [1e-8, 1]. Contacts of a face are redundant and disagree by millimetres: smaller values
  /// make the step fit that disagreement, larger ones leave more of the slow error behind. The
  /// solver raises it on an island where a step was rejected, and lowers it while steps are kept:
  /// down to 1/4 of this, with a budget to 1/32.
  double proximal = 3e-3;
  /// The same on rows without bounds (joints), in [1e-12, 1]. Where joints are redundant, each step
  /// adds impulses of what they contradict each other divided by it, which floats cannot hold
  /// against each other for long: there joints are condensed, and softened if that is not enough.
  /// docs/solver.md, Guards.
  double proximal_joints = 1e-6;
  /// Solves with the last factor of a step at most, in [1, 1000]. Those after the first refine it
  /// while no row leaves its bounds; see docs/solver.md before raising it.
  int refinements = 1;
};

/// The first setting that is out of its range, if any: what Solve() answers Status::kBadSettings
/// to.
[[nodiscard]] BadSetting FindBadSetting(const Settings& settings);

/// Whether contact problems are swept in blocks, in floats, as far as these say; otherwise row by
/// row in double precision.
bool SweepsInFloats(const Settings& settings);

}  // namespace cairn
