// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "cairn/detail/memory.h"

namespace cairn {

/// Why the iteration ended. Of several islands the last in this order is told.
enum class StopReason {
  kNotStarted,  ///< The input was refused.
  kConverged,   ///< Residual <= Settings::tolerance.
  kStationary,  ///< A sweep moved no row by more than Tuning::min_progress.
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
  kPaused,        ///< One was undone or too dear of late; docs/solver.md, A cycle.
  kTooDear,       ///< It would not have fitted the budget, or cost more than it can gain.
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

/// Of rows that take back an error of position (not of Row), the one that asks for most [m/s],
/// [rad/s]: that, and what bodies then do of it. Times the step, what it was told of an error.
struct Correction {
  double asked = 0, done = 0;
};

/// What kept an island from putting in energy that nothing asks for. Where a step or the result was
/// guarded it is left to sweeps for a while. Method::kPgsSm with LiftedFriction::kRelease only.
struct Guards {
  bool start = false;   ///< After the first sweeps impulses were worse than none, and scaled down.
  bool step = false;    ///< A subspace step was undone: it put in energy, threw, flung or squeezed
                        ///< bodies, or left impulses against each other that floats cannot hold.
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
  /// On Path::kReference of the start itself.
  Residual residual_before;
  Residual residual;  ///< Of the result.
  /// What impulses are worth [J], 0 for none: 1/2 |M^-1/2 J'x|^2 + 1/2 x'E x - (target - J
  /// v_free)'x, the energy that the problem minimises with bounds of friction frozen. At 0 or
  /// below, the kinetic energy after the step is at most that without impulses and what targets put
  /// in (docs/solver.md has a bound of that).
  double merit = 0;
  Guards guards;
  int sweeps = 0, factorisations = 0;
  int steps_accepted = 0;  ///< Subspace steps kept.
  int steps_restored = 0;  ///< Subspace steps undone, because the sweeps after them ended worse.
  /// Work units of subspace steps, kept or not, without their sweeps. Common ones: shared by rows.
  std::int64_t step_work = 0;
  double strain = 0;  ///< Largest Body::strain; next: whose, and substeps that bring it to 2.
  int strained_body = -1, enough_substeps = 0;
  double speed = 0, spin = 0;  ///< Largest of its bodies after the step [m/s], [rad/s].
  int quiet = 0;  ///< Solve()s in a row, with this one, that left all below Tuning::quiet_speed.
  NoStep no_step = NoStep::kNotAsked;
  StopReason stop = StopReason::kNotStarted;
};

/// What the clock decided in a Solve() with Budget::Time. Given back as Tuning::replay, with the
/// same frames before it, it makes the same frame again, to the bit, on any machine.
struct Replay {
  /// Work units done when the time was up, the largest number if it never was.
  std::int64_t work = std::numeric_limits<std::int64_t>::max();
  /// Answers of the clock on the way, each 0 or 1: whether there was time for a step, say.
  Array<std::uint8_t> fits;

  friend bool operator==(const Replay&, const Replay&) = default;
};

/// A setting out of its range, a size that does not fit, or a field of what was refused: "<name> is
/// <value>, must be <range>".
struct BadSetting {
  const char* name = nullptr;  ///< As in Settings, "threads" say; nullptr: none is to blame.
  double value = 0;            ///< Of an enum its number, of a budget nanoseconds or work units.
  const char* range = "";      ///< "1 to 1024", say.
};

/// "threads is 0, must be 1 to 1024". @pre it has a name
std::string Describe(const BadSetting& bad);

}  // namespace cairn
