// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/detail/cpp20.h"

#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace cairn {

/// Whether the input could be used. All but kOk leave every output untouched.
enum class Status {
  kOk,
  kBadSettings,   ///< A field of Settings is out of its range.
  kEmptyProblem,  ///< No bodies.
  kWrongSize,     ///< A span of results does not have one entry per row, point or body, or a
                  ///< manifold has points that are not there.
  kNotFinite,     ///< NaN, or infinity anywhere but in a bound; a bounce speed below 0.
  kBadMass,     ///< Negative inverse mass, or inverse inertia not symmetric positive semidefinite.
  kNoSuchBody,  ///< A row or manifold names a body that is not there, or the same one twice.
  kBadBounds,   ///< lo > hi.
  kBadCompliance,  ///< Negative compliance, or relaxation outside (0, 2).
  kBadParent,      ///< The parent of a friction row comes later, is itself a friction row, or
                   ///< joins other bodies.
  kBadFriction,    ///< Negative friction coefficient, or restitution.
  kOverflow,       ///< Numbers are finite, but too large or too far apart for a finite result.
};

/// One sentence for people, without a full stop.
std::string_view Describe(Status status);

/// Why the iteration ended.
enum class StopReason {
  kNotStarted,  ///< The input was refused.
  kConverged,   ///< Residual <= Settings::tolerance.
  kStationary,  ///< A sweep moved no row by more than Settings::min_progress.
  kBrokeDown,   ///< Report::status says why.
  kSweepLimit,  ///< Settings::max_sweeps done.
  kTimeSpent,   ///< Budget::Time reached.
  kWorkSpent,   ///< Budget::Work reached.
};

std::string_view Describe(StopReason reason);

/// Why no further subspace step was taken on an island.
enum class NoStep {
  kNotAsked,      ///< Not by Settings.
  kEnded,         ///< The iteration ended before another one was due.
  kPaused,        ///< One was undone or too dear of late; see StepPolicy::kMeasured.
  kTooDear,       ///< It would not have fitted the budget with its sweeps, or cost more than it can
                  ///< gain.
  kSweepsFaster,  ///< Sweeps in its place are predicted to gain more.
};

std::string_view Describe(NoStep reason);

/// How far impulses are from the solution, measured by the natural map
///   e_i = d_i |x_i - clamp(x_i - w_i / d_i, lo_i, hi_i)|,   d_i = J_i M^-1 J_i' + E_i,
/// with the bounds of friction rows taken from the present impulse of their parent.
struct Residual {
  double max = 0;          ///< Largest e_i of the rows that act on points [m/s].
  double max_angular = 0;  ///< Largest e_i of the rows that only turn [rad/s].
  double energy = 0;       ///< sqrt(sum e_i^2 / d_i) [sqrt(J)].
};

/// What the solver did on an island to keep it from putting in energy that nothing asks for. An
/// island on which a step or the result was guarded is left to sweeps for a while. Method::kPgsSm
/// with LiftedFriction::kRelease only; plain methods are what their names say.
struct Guards {
  bool start = false;  ///< The start impulses were worse than none, and scaled down.
  bool step = false;   ///< A subspace step was undone: it put in energy, or left impulses of joints
                       ///< that floats cannot hold against each other.
  bool result = false;  ///< The impulses of the last sweep were worse than none, and scaled down.

  bool any() const { return start || step || result; }
  friend bool operator==(const Guards&, const Guards&) = default;
};

/// What was done on one island: bodies connected by rows, world excluded.
struct IslandReport {
  int first_body = -1;  ///< Lowest index of its bodies in the problem.
  int bodies = 0;
  int rows = 0;
  /// Of the start, as the first sweep finds it: each row when its turn comes, which costs nothing.
  /// On the reference path (SweepOrder::kForward and its like) of the start itself.
  Residual residual_before;
  Residual residual;  ///< Of the result.
  /// What impulses are worth [J], 0 for none: 1/2 |M^-1/2 J'x|^2 + 1/2 x'E x - (target - J
  /// v_free)'x, the energy that the problem minimises with bounds of friction frozen. At 0 or
  /// below, the kinetic energy after the step is at most that without impulses and what the targets
  /// of rows put in. docs/solver.md has a bound of that.
  double merit = 0;
  Guards guards;
  int sweeps = 0;
  int factorisations = 0;
  int steps_accepted = 0;  ///< Subspace steps kept.
  int steps_restored = 0;  ///< Subspace steps undone, because the sweeps after them ended worse.
  /// Work units charged for subspace steps, kept or not, without the sweeps around them. Steps that
  /// islands take together are shared out by rows.
  std::int64_t step_work = 0;
  NoStep no_step = NoStep::kNotAsked;
  StopReason stop = StopReason::kNotStarted;
};

/// What the clock decided in a Solve() with Budget::Time. Given back as Settings::replay, with the
/// same frames before it, it makes the same frame again, to the bit, on any machine.
struct Replay {
  /// Work units done when the time was up, the largest number if it never was.
  std::int64_t work = std::numeric_limits<std::int64_t>::max();
  std::vector<std::uint8_t> fits;  ///< For each step considered, whether there was time for it.

  friend bool operator==(const Replay&, const Replay&) = default;
};

/// A setting that is out of its range, in words for people: "<name> is <value>, must be <range>".
struct BadSetting {
  const char* name = nullptr;  ///< As in Settings, "threads" say; nullptr: all are in range.
  double value = 0;            ///< Of an enum its number, of a budget nanoseconds or work units.
  const char* range = "";      ///< "1 to 1024", say.
};

/// "threads is 0, must be 1 to 1024". @pre it has a name
std::string Describe(const BadSetting& bad);

/// What was done, and how good the result is.
struct [[nodiscard]] Report {
  Status status = Status::kOk;
  BadSetting bad_setting;  ///< First setting refused: Status::kBadSettings.
  int bad_row = -1;        ///< First row refused, -1 if what is wrong is not a row.
  int bad_body = -1;       ///< First body refused, -1 likewise.
  int bad_manifold = -1;   ///< First manifold refused, -1 likewise.
  int bad_joint = -1;      ///< First joint refused, -1 likewise.

  double residual_max = 0;      ///< Residual::max over all islands [m/s].
  double residual_angular = 0;  ///< Residual::max_angular over all islands [rad/s].
  double residual_energy = 0;   ///< Residual::energy over all islands [sqrt(J)].
  int sweeps = 0;               ///< Most sweeps made on one island.
  int factorisations = 0;       ///< Sum over islands, like the two below.
  int steps_accepted = 0;
  int steps_restored = 0;
  int guarded = 0;  ///< Islands that something was guarded on; see Guards.
  StopReason stop = StopReason::kNotStarted;  ///< The one that held back most: a budget spent on
                                              ///< any island before a sweep limit before the rest.
  std::int64_t work = 0;                      ///< Work units spent; see Budget::Work.
  Replay replay;                              ///< Contact problems with Budget::Time.
  std::chrono::nanoseconds elapsed{0};        ///< Wall clock of the Solve(), whatever the budget.
  /// What subspace steps were predicted to take, with the factorisations that they made, and what
  /// they took, without the sweeps around them: contact problems with Budget::Time, else 0.
  std::chrono::nanoseconds step_predicted{0}, step_time{0};
  std::vector<IslandReport> islands;
  std::vector<int> island_of;  ///< By body: its place in islands, -1 for one without rows. Of a
                               ///< contact problem that was solved.

  bool ok() const { return status == Status::kOk; }
};

/// One sentence for people, without a full stop: what is wrong, and where. "threads is 0, must be 1
/// to 1024", or "row 7: the lower bound ...". If all is well, why the iteration ended.
std::string Describe(const Report& report);

}  // namespace cairn
