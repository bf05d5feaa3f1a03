// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "cairn/detail/memory.h"
#include "cairn/report_details.h"

namespace cairn {

/// Which code solves.
enum class Path {
  kAuto,  ///< kFast, unless Settings::tolerance is too fine for floats: positive and below 1e-5.
  /// In floats, 16 pairs of bodies at a time in vector registers, colour by colour, on all threads;
  /// the same bits for any instruction set and number of threads. What floats cannot hold (a start
  /// or d = J M^-1 J' + E beyond 1e12, say) is left to kReference.
  kFast,
  /// In double precision, row by row in the order of the problem, on one thread, without
  /// acceleration: slower, and the specification of the method. See docs/solver.md.
  kReference,
};

/// Whether the input could be used. All but kOk leave every output untouched.
enum class Status {
  kOk,
  kBadSettings,   ///< A field of Settings is out of its range.
  kEmptyProblem,  ///< No bodies.
  kWrongSize,     ///< A span has not one entry per row, point or body that it is for.
  kNotFinite,     ///< NaN, or infinity anywhere but in a bound; a bounce speed below 0.
  kBadMass,     ///< Negative inverse mass, or inverse inertia not symmetric positive semidefinite.
  kNoSuchBody,  ///< A row, joint or manifold names a body that is not there, or one twice.
  kBadBounds,   ///< lo > hi, lo = +inf or hi = -inf; 0 is outside those of a row of friction.
  kBadCompliance,  ///< Negative compliance, or relaxation outside (0, 2).
  kBadParent,      ///< Not an earlier row of the same two bodies with bounds of its own.
  kBadFriction,    ///< Negative friction, restitution, or bound of a ContactTwist.
  kOverflow,       ///< Numbers are finite, but too large or too far apart for a finite result.
};

std::string_view Describe(Status status);  ///< One sentence for people, without a full stop.

/// What was done, and how good the result is.
struct [[nodiscard]] Report {
  Status status = Status::kOk;
  BadSetting bad_setting;  ///< First setting, size or field refused, if it is one.
  /// The first row, body, manifold or joint refused, -1 if what is wrong is none.
  int bad_row = -1, bad_body = -1, bad_manifold = -1, bad_joint = -1;
  Path path = Path::kAuto;  ///< What solved, kFast or kReference; kAuto: nothing did.

  double residual_max = 0;      ///< Residual::max over all islands [m/s].
  double residual_angular = 0;  ///< Residual::max_angular over all islands [rad/s].
  double residual_energy = 0;   ///< Residual::energy over all islands [sqrt(J)].
  int sweeps = 0;               ///< Most sweeps made on one island.
  int factorisations = 0;       ///< Sum over islands, like the next two.
  int steps_accepted = 0, steps_restored = 0;
  int guarded = 0;  ///< Islands that something was guarded on; see Guards.
  StopReason stop = StopReason::kNotStarted;  ///< Of all islands, the last in its order.
  Correction depth, gap, angle;  ///< Of contacts, of joints, and of their rows that only turn.
  std::int64_t work = 0;         ///< Work units spent; see Budget::Work.
  Replay replay;                 ///< With Budget::Time, one substep and no Settings::relax.
  std::chrono::nanoseconds elapsed{0};  ///< Wall clock of the Solve(), whatever the budget.
  /// With Budget::Time: what subspace steps were predicted to take, and took, without their sweeps.
  std::chrono::nanoseconds step_predicted{0}, step_time{0};
  Array<IslandReport> islands;  ///< An Array is a std::vector.
  Array<int> island_of;         ///< By body: its place in islands, -1 for one without rows.

  bool ok() const { return status == Status::kOk; }
};

/// One sentence for people, without a full stop: what is wrong, and where. "threads is 0, must be 1
/// to 1024", or "row 7: the lower bound ...". If all is well, why the iteration ended.
std::string Describe(const Report& report);

}  // namespace cairn
