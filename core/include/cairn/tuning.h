// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <chrono>

#include "cairn/detail/host.h"
#include "cairn/report.h"

namespace cairn {

class SpanRecorder;  // cairn/detail/spans.h

/// When a subspace step is taken.
enum class StepPolicy {
  kMeasured,  ///< Where it is predicted to pay, and no longer where it was measured not to.
  kAlways,    ///< After every k_gs sweeps that may be followed by k_gs more, at any cost.
  /// Where it lowers the energy by more than the sweeps in its place would, and is predicted to
  /// cost about as much as all else on its island at most. Islands without a step go on for up to
  /// twice max_sweeps; docs/solver.md, Effort. On Path::kFast without a budget; elsewhere as
  /// kMeasured.
  kWeighed,
};

/// Whether sweeps build on each other: Method::kPgsSm on Path::kFast.
enum class Acceleration {
  kNone,
  /// Nonsmooth nonlinear conjugate gradients (Silcowitz-Niebe and Erleben 2010): before a sweep the
  /// state moves on along what the last ones changed. One such sweep is worth several, see
  /// docs/benchmarks.md.
  kNncg,
};

/// Where Budget::Time gets the time from. One that goes back is taken to stand still until it has
/// caught up; while it stands still, Settings::max_sweeps and Settings::tolerance end a Solve().
class Clock {
 public:
  virtual ~Clock() = default;
  /// Since any fixed point. Asked by the thread that calls Solve().
  virtual std::chrono::nanoseconds Now() const = 0;
};

/// Settings for experiments, measurements and comparison with other methods. Try another value on
/// many worlds, not on one (docs/tuning.md).
struct Tuning {
  /// Also done when a whole sweep moved no row by more than this, [m/s] or [rad/s], >= 0.
  double min_progress = 0;
  /// Sweeps made even if the budget is spent before them: >= 0, or kByBudget. At 0 a budget that is
  /// too small for anything returns the warm start.
  int min_sweeps = kByBudget;
  /// With Budget::Time: kLateSweeps; elsewhere 1. See docs/tuning.md, Too late.
  static constexpr int kByBudget = -1, kLateSweeps = 4;
  /// Over-relaxation of Method::kPsor, above 0 and below 2; 1 is Gauss-Seidel. Other than 1, joints
  /// and manifolds are solved on Path::kReference.
  double omega = 1;
  /// Proximal term of a subspace step on rows with bounds, relative to their diagonal, in [1e-8,
  /// 1]. Small values fit what contacts of a face disagree by, large ones leave slow errors. Raised
  /// where a step failed, lowered while steps are kept: to 1/4 of it, with a budget to 1/32.
  double proximal = 3e-3;
  /// Solves with the last factor of a step at most, in [1, 1000]. Those after the first refine it
  /// while no row leaves its bounds; see docs/solver.md before raising it.
  int refinements = 1;
  double quiet_speed = 0.05;  ///< Of IslandReport::quiet [m/s], [rad/s], >= 0.
  /// Units of length in a metre, 100 in centimetres, for settings in [m/s]; 0: 1, in Bullet what
  /// gravity says.
  double units_per_metre = 0;
  detail::LiftedFriction lifted_friction = detail::LiftedFriction::kRelease;
  /// A frame to be made again: its work instead of the budget, its answers instead of the clock's.
  /// nullptr: none. One substep only. Outlives the Solve(), whose report it is not part of.
  const Replay* replay = nullptr;
  /// Notes which thread did what when, on Path::kFast, or nullptr. Must outlive every Solve().
  SpanRecorder* spans = nullptr;
  /// Of Budget::Time; nullptr: std::chrono::steady_clock. Must outlive every Solve().
  const Clock* clock = nullptr;
};

}  // namespace cairn
