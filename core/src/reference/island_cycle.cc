// SPDX-License-Identifier: MIT
#include "reference/island_cycle.h"

#include <algorithm>
#include <utility>

#include "reference/residual.h"
#include "reference/row_merit.h"
#include "reference/row_sweep.h"
#include "reference/step.h"
#include "reference/step_price.h"
#include "sweep/settle_friction.h"

namespace cairn {
namespace {

/// Rows between two looks at the budget: about 5 us.
constexpr int kBlockRows = 256;
/// A residual costs about half a sweep.
constexpr double kMeasureSweeps = 0.5;
/// A step that brought the residual down to this share is kept without trying sweeps alone.
constexpr double kSureGain = 0.1;
/// Rows that hold a point of one body to one of another.
constexpr int kHoldsPoint = 3;

/// Whether some rows are of a joint that holds bodies together: without bounds, or, as of one that
/// breaks, all that hold a point with some. Rows of a joint follow each other.
bool HoldsTogether(std::span<const PackedRow> rows) {
  int bounded = 0;
  for (size_t i = 0; i < rows.size(); ++i) {
    const PackedRow& row = rows[i];
    if (!HasBounds(row)) return true;
    if (i == 0 || row.a != rows[i - 1].a || row.b != rows[i - 1].b) bounded = 0;
    const bool pushes = row.lo == 0 && row.hi == kInfinity;
    if (row.parent == kNoRow && !pushes && !row.angular) ++bounded;
    if (bounded == kHoldsPoint) return true;
  }
  return false;
}

}  // namespace

IslandCycle::IslandCycle(const PackedIsland& island, IslandState start, const Settings& settings,
                         IslandMemory* memory)
    : island_(island), settings_(settings), memory_(memory), at_{.state = std::move(start)} {
  const bool asked = settings_.method == Method::kPgsSm && settings_.k_sm > 0;
  if (asked) report_.no_step = NoStep::kEnded;
  guards_ = IsGuarded(settings_);
  joints_ = HoldsTogether(island_.rows);
  report_.residual_before = MeasureResidual(island_, at_.state);
  if (settings_.max_sweeps == 0 || island_.rows.empty()) Stop(StopReason::kSweepLimit);
}

bool IslandCycle::GuardState() {
  if (!guards_) return false;
  const Merit merit = MeasureMerit(island_, at_.state);
  if (!merit.is_worse_than_none()) return false;
  ScaleState(merit.best_scale(), &at_.state);
  return true;
}

void IslandCycle::Advance(BudgetMeter* meter) {
  if (Spent(*meter)) return Stop(meter->stop_reason());
  // what was left when it was planned, other islands may have spent since
  const bool stepped = std::exchange(step_next_, false) && StepFits(meter);
  if (stepped) {
    StepRound(meter);
  } else {
    Sweeps(SweepsOfRound(), meter);
  }
  if (done()) return;
  if (at_.sweeps >= settings_.max_sweeps) return Stop(StopReason::kSweepLimit);

  const bool may_step = !stepped && StepsLeft();
  if (may_step || settings_.tolerance > 0) {
    residual_ = MeasureNow(meter);
    if (IsWithin(residual_, settings_.tolerance, UnitOf(settings_)))
      return Stop(StopReason::kConverged);
  }
  step_next_ = may_step && StepPays(meter);
}

bool IslandCycle::Spent(const BudgetMeter& meter) const {
  return meter.spent() && at_.sweeps >= LeastSweeps(settings_);
}

int IslandCycle::SweepsOfRound() const {
  return std::min(settings_.k_gs, settings_.max_sweeps - at_.sweeps);
}

Residual IslandCycle::MeasureNow(BudgetMeter* meter) const {
  meter->Begin();
  const Residual residual = MeasureResidual(island_, at_.state);
  meter->Charge(WorkKind::kSweep, kMeasureSweeps * units_per_sweep());
  return residual;
}

bool IslandCycle::SweepOnce(BudgetMeter* meter) {
  const int rows = static_cast<int>(island_.rows.size());
  double moved = 0;
  meter->Begin();
  for (int begin = 0; begin < rows; begin += kBlockRows) {
    if (Spent(*meter)) {
      if (begin > 0) {
        ProjectFriction(island_, {begin, rows, at_.sweeps}, settings_.tuning.lifted_friction,
                        &at_.state);
      }
      Stop(meter->stop_reason());
      return false;
    }
    const int end = std::min(begin + kBlockRows, rows);
    moved = std::max(moved, SweepRows(island_, {begin, end, at_.sweeps},
                                      settings_.tuning.lifted_friction, &at_.state));
    meter->Charge(WorkKind::kSweep, end - begin);
  }
  ++at_.sweeps;
  if (at_.sweeps == GuardedSweep(joints_) && GuardState()) {
    report_.guards.start = true;
    return true;
  }
  if (moved / UnitOf(settings_) <= settings_.tuning.min_progress) Stop(StopReason::kStationary);
  return !done();
}

void IslandCycle::Sweeps(int count, BudgetMeter* meter) {
  for (int k = 0; k < count; ++k) {
    if (!SweepOnce(meter)) return;
  }
}

bool IslandCycle::StepsLeft() const {
  const bool asked = settings_.method == Method::kPgsSm && settings_.k_sm > 0;
  const int sweeps_left = settings_.max_sweeps - at_.sweeps;
  return asked && island_.bodies > 0 &&
         sweeps_left >= std::min(settings_.k_gs, kLeastSweepsAfterStep);
}

double IslandCycle::UnitsAfterStep() const {
  // its sweeps, and as many without it, which it has to beat
  return 2 * (SweepsOfRound() + kMeasureSweeps) * units_per_sweep();
}

bool IslandCycle::StepFits(BudgetMeter* meter) const {
  return meter->Fits(MostStepCost(island_, settings_, memory_), UnitsAfterStep());
}

bool IslandCycle::StepPays(BudgetMeter* meter) {
  const bool due = memory_->Due(settings_);
  const bool pays = due && cairn::StepPays(island_, settings_, {meter, UnitsAfterStep()}, memory_);
  report_.no_step = pays ? NoStep::kEnded : due ? NoStep::kTooDear : NoStep::kPaused;
  return pays;
}

void IslandCycle::StepRound(BudgetMeter* meter) {
  const Point before = at_;
  const StepSettings step = memory_->Step(settings_);
  meter->Begin();
  StepResult result = TakeStep(island_, step, &SystemOf(memory_), &at_.state);
  const double unit = UnitOf(settings_);
  result.ToMetres(unit);
  report_.factorisations += result.factorisations;
  const double cost = StepCost(island_, settings_, result.factorisations, SystemOf(memory_));
  meter->Charge(WorkKind::kStep, cost);
  report_.step_work += static_cast<std::int64_t>(cost);

  // judged after sweeps: before them, nearly every good step looks worse
  Sweeps(SweepsOfRound(), meter);
  memory_->SawJoints(result);
  const Merit merit_before = MeasureMerit(island_, before.state),
              merit = MeasureMerit(island_, at_.state);
  const double error = unit * Largest(residual_, unit);
  const bool violent = IsTooViolent(merit_before, merit, island_.mass, error);
  const IslandMotion motion_before =
      LargerOf(MeasureMotion(island_, before.state, 0), MeasureMotion(island_, before.state, 1));
  const bool flung =
      IsFlung(motion_before, MeasureMotion(island_, at_.state, 1), island_.mass, error);
  const Residual with_step = MeasureNow(meter);
  const bool squeezed =
      !joints_ && IsSqueezed({residual_.energy, with_step.energy, merit_before, merit});
  const bool harmful =
      squeezed || violent || flung || merit.is_worse_than_none() || IsTooMuch(result.joint_speed);
  const bool sound = !guards_ || !harmful;
  if (!sound) {
    report_.guards.step = true;
    memory_->Guarded();
  }
  if (result.solved && KeepBetter(before, sound, with_step, meter)) {
    memory_->Accepted();
    ++report_.steps_accepted;
  } else {
    memory_->Restored();
    ++report_.steps_restored;
  }
}

bool IslandCycle::KeepBetter(Point before, bool sound, const Residual& with_step,
                             BudgetMeter* meter) {
  if (sound && with_step.energy <= kSureGain * residual_.energy) return true;

  // the same number of sweeps without the step, as far as the budget goes
  const double merit = MeasureMerit(island_, at_.state).value();
  Point stepped = std::exchange(at_, std::move(before));
  Sweeps(stepped.sweeps - at_.sweeps, meter);
  // what is not a number is not kept
  const StepTrial trial{.with_step = with_step.energy,
                        .alone = MeasureNow(meter).energy,
                        .lead = MeasureMerit(island_, at_.state).value() - merit};
  if (!sound || trial.is_better_alone()) return false;
  at_ = std::move(stepped);
  return true;
}

void IslandCycle::SettleFriction() {
  const bool limited =
      settings_.budget.kind() != Budget::Kind::kUnlimited || settings_.tuning.replay != nullptr;
  const bool ends_rough = at_.stop == StopReason::kSweepLimit && at_.sweeps > 0;
  if (!SettlesFriction(settings_) || limited || !ends_rough || joints_) return;
  // rows that took part in the last sweep do
  SweepFriction(island_, at_.sweeps - 1, settings_.tuning.lifted_friction, &at_.state);
}

IslandReport IslandCycle::Finish() {
  SettleFriction();
  report_.guards.result = GuardState();
  if (report_.guards.result) memory_->Guarded();
  report_.merit = MeasureMerit(island_, at_.state).value();
  report_.bodies = island_.bodies;
  report_.rows = static_cast<int>(island_.rows.size());
  report_.sweeps = at_.sweeps;
  report_.stop = at_.stop;
  // what increments have rounded away is not in the report, and not in the velocities
  RecomputeVelocities(island_, &at_.state);
  report_.residual = MeasureResidual(island_, at_.state);
  return report_;
}

}  // namespace cairn
