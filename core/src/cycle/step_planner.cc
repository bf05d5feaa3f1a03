// SPDX-License-Identifier: MIT
#include "cycle/step_planner.h"

#include <algorithm>

#include "sweep/block_sweep.h"
#include "sweep/nncg.h"

namespace cairn {
namespace {

/// What fewer sweeps gain says too little; after a step, whose trace they carry, even more so.
constexpr int kLeastRun = 9, kLeastRunAfterStep = 30;
/// A step that is weighed costs at most this share of all else on its island in whole lines, as
/// prices have it: those of steps in doubles are a third too high.
constexpr double kMostOfRest = 1.5, kMostOfRestWithJoints = 1.0;
/// And all of it together so many times what sequential impulses row by row do. With more of both
/// wild chains at 30 Hz take steps that tear them.
constexpr double kMostOfScalar = 1.15, kMostOfScalarWithJoints = 1.6;
/// With joints and more than one factorisation: the first one holds them, others make them exact.
/// Strained bridges under crates need those: they fall to pieces with 1.4 and gape with 1.6.
constexpr double kMostOfScalarWithMore = 1, kMostOfScalarWithMoreStrained = 2;
/// By so much more where there was a step of late, since steps that come and go do harm, and where
/// joints pull. Without joints that is for one factorisation.
constexpr double kMoreOnceStepped = 1.5;
/// Within so many tolerances sweeps do the rest.
constexpr double kNear = 10;
/// Error of joints that a step meets at most where there was none in the last frame [m/s]. What
/// only turns is not thrown, and a gear or motor that sweeps leave behind would never get a step.
/// Contacts part by centimetres at most, and what flings bodies is undone: towers that rock would
/// never get a step again.
constexpr double kMostThrown = 1;
/// The same where it is strained: what waits longer parts further.
constexpr double kMostThrownStrained = 3;
/// What costs more sweeps than this is not tried.
constexpr double kMostSweeps = 1000;

}  // namespace

void StepPlanner::Begin(const CycleFrame& frame, BlockSteps* steps, CycleIslands* islands) {
  frame_ = &frame;
  steps_ = steps;
  islands_ = islands;
  planned_.clear();
}

std::span<const int> StepPlanner::PlanRound() {
  planned_.clear();
  const Settings& settings = frame_->settings;
  const int left = settings.max_sweeps - islands_->SweepsMade();
  if (!steps_->asked() || left < std::min(frame_->sweeps_of_round(), kLeastSweepsAfterStep))
    return planned_;
  Planned planned;
  for (int g = 0; g < static_cast<int>(islands_->groups().size()); ++g) {
    const size_t first = planned_.size();
    AddCandidates(g);
    if (planned_.size() == first) continue;

    const auto islands = std::span(planned_).subspan(first);
    const NoStep refused = PlanStep(g, islands, &planned);
    if (refused == NoStep::kEnded) {
      if (frame_->weighs_steps()) KeepWorthwhile(g, first);
      continue;
    }
    // there is never more left of a budget; the next frame has its own
    for (int i : islands) {
      (*islands_)[i].EndSteps();
      islands_->report(i).no_step = refused;
      if (!frame_->watches_gains()) steps_->Postpone(i);
    }
    planned_.resize(first);
  }
  return planned_;
}

void StepPlanner::AddCandidates(int g) {
  const Plan& plan = frame_->plan();
  const Group& group = plan.groups()[g];
  for (int i : plan.islands_in(group)) {
    if (!(*islands_)[i].MayStep() || plan.islands()[i].first_body < 0) continue;
    NoStep no_step = steps_->Due(i) ? NoStep::kEnded : NoStep::kPaused;
    if (no_step == NoStep::kEnded && frame_->weighs_steps()) no_step = Weigh(g, i);
    if (no_step == NoStep::kEnded) planned_.push_back(i);
    islands_->report(i).no_step = no_step;
  }
}

NoStep StepPlanner::PlanGraph(int g, std::span<const int> islands, const Planned& planned) {
  BudgetMeter& meter = *frame_->meter;
  const double guess = steps_->Guess(g, islands);
  if (guess == 0) return NoStep::kEnded;
  const auto pays = [&](double price) { return Pays(g, islands, planned.steps, price); };
  if (!meter.Fits(planned.steps + guess, planned.sweeps)) return NoStep::kTooDear;
  if (!pays(guess)) return NoStep::kSweepsFaster;
  const auto analysis = steps_->PriceOfAnalysis(g, islands);
  if (analysis.whole > 0) {
    // where the step does not fit any more after it, it will in the next frame
    if (!meter.FitsAnalysis(analysis.whole, planned.steps, planned.sweeps)) {
      return NoStep::kTooDear;
    }
    if (!pays(guess + analysis.of_step)) return NoStep::kSweepsFaster;
    steps_->Analyse(g, islands);
  }
  return NoStep::kEnded;
}

NoStep StepPlanner::PlanStep(int g, std::span<const int> islands, Planned* planned) {
  // after the step its sweeps, and, where that is not foreseen, as many without it
  const Settings& settings = frame_->settings;
  const Group& group = frame_->plan().groups()[g];
  const int left = settings.max_sweeps - islands_->SweepsMade();
  const double sweeps =
      (frame_->watches_gains() ? 1.0 : 2.0) * std::min(frame_->sweeps_of_round(), left) +
      2 * BlockSweeps::kMeasureSweeps;
  const double rows = static_cast<double>(group.rows);
  // what a sweep costs does not depend on how full the lanes are, so that an island does not see
  // who shares them
  const double lanes = static_cast<double>(simd::kLanes) * group.x_lines;
  const Planned before{planned->steps, planned->sweeps + sweeps * rows};
  if (const NoStep refused = PlanGraph(g, islands, before); refused != NoStep::kEnded) {
    return refused;
  }
  // as many factorisations as fit, and half of them where they do not
  const bool always = settings.step_policy == StepPolicy::kAlways;
  NoStep refused = NoStep::kTooDear;
  for (int most = settings.k_sm; most > 0; most /= 2) {
    const double price = steps_->Price(g, islands, most);
    if (!always && price > kMostSweeps * lanes) continue;
    if (!frame_->meter->Fits(before.steps + price, before.sweeps)) continue;
    refused = NoStep::kSweepsFaster;
    if (!Pays(g, islands, before.steps, price)) continue;
    for (int i : islands) steps_->Limit(i, most);
    *planned = {before.steps + price, before.sweeps};
    return NoStep::kEnded;
  }
  return refused;
}

NoStep StepPlanner::Weigh(int g, int i) {
  const StepOdds& odds = steps_->odds(i);
  const bool joints = steps_->HasJoints(i);
  const Residual& seen = (*islands_)[i].seen;
  const double unit = UnitOf(frame_->settings);
  const bool near = IsWithin(seen, kNear * frame_->settings.tolerance, unit);
  // what sweeps have left joints open by for long, a single step would throw
  const int bodies = frame_->plan().islands()[i].bodies;
  const bool strained = steps_->IsStrained(i);
  const bool thrown = joints && !odds.stepped_most(bodies) &&
                      seen.max > unit * (strained ? kMostThrownStrained : kMostThrown);
  const bool pays = steps_->IsNeeded(i) || odds.pays() || odds.wants_trial();
  if (near || thrown || !pays) return NoStep::kSweepsFaster;
  const int sweeps = frame_->settings.max_sweeps;
  const double of_scalar = joints ? kMostOfScalarWithJoints : kMostOfScalar;
  const double share = joints ? kMostOfRestWithJoints : kMostOfRest;
  const double of_rest = share * steps_->RestInWholeLines(i, sweeps);
  const double scalar = steps_->ScalarAlone(i, sweeps), rest = steps_->RestAlone(i, sweeps);
  const double left = of_scalar * scalar - rest;
  const double of_more = strained ? kMostOfScalarWithMoreStrained : kMostOfScalarWithMore;
  const bool gross = bodies <= StepOdds::kFewBodies && odds.stays_gross();
  const bool rocks = steps_->SizeOf(i) == StepOdds::Size::kFewest && odds.stays_rough();
  // what sweeps let fall in the first frames a later step stops at once, with a jerk that breaks
  const bool begins = joints && odds.is_new();
  const double most_price =
      strained || gross || rocks || begins ? of_rest : std::min(of_rest, left);
  const int condensing = !strained && steps_->CondensesJoints(i) ? 1 : 0;
  const auto fits = [&](int factorisations) {
    const bool first = factorisations == 1;
    const bool more = first && (strained || odds.stepped_of_late());
    double most = (more ? kMoreOnceStepped : 1) * most_price;
    if (!first && joints) most = std::min(most, of_more * scalar - rest);
    return steps_->PriceAlone(g, i, factorisations + condensing, most) <= most;
  };
  int most = frame_->settings.k_sm;
  while (most > 0 && !fits(most)) most /= 2;
  steps_->Limit(i, most);
  return most > 0 ? NoStep::kEnded : NoStep::kTooDear;
}

void StepPlanner::KeepWorthwhile(int g, size_t first) {
  // their graphs are known now
  const auto islands = planned_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto refused = std::remove_if(islands, planned_.end(), [this, g](int i) {
    islands_->report(i).no_step = Weigh(g, i);
    return islands_->report(i).no_step != NoStep::kEnded;
  });
  planned_.erase(refused, planned_.end());
}

bool StepPlanner::Pays(int g, std::span<const int> islands, double planned, double price) {
  if (!frame_->watches_gains()) return true;
  const bool first = std::all_of(islands.begin(), islands.end(), [&](int i) {
    const StepOdds& odds = steps_->odds(i);
    return odds.carries() && islands_->StepsTaken(i) == 0 && !odds.stale();
  });
  if (first) return true;
  double cut = 0, power = 0;
  int sweeps = frame_->settings.max_sweeps;
  for (int i : islands) {
    const StepOdds& odds = steps_->odds(i);
    if (odds.stale()) return false;
    cut += odds.cut(islands_->StepsTaken(i));
    power += odds.power();
    sweeps = std::min(sweeps, islands_->SweepsMade() - (*islands_)[i].run.begin);
  }
  if (cut <= 0) return false;
  // of what is left each group has its share
  BudgetMeter& meter = *frame_->meter;
  const double all_rows = islands_->ActiveRows();
  const double shares = all_rows / static_cast<double>(frame_->plan().groups()[g].rows);
  const double sweep = all_rows * (1 + (frame_->accelerates() ? Nncg::kSweeps : 0));
  const double smoothing = frame_->sweeps_of_round() + 2 * BlockSweeps::kMeasureSweeps;
  const double prices = StepOdds::PricesLeft(cut / power);
  if (meter.Fits(prices * shares * price, (prices * smoothing - sweeps) * sweep)) return true;
  // where sweeps have another limit than the budget, a step takes nothing from them
  const double left = frame_->settings.max_sweeps - islands_->SweepsMade();
  return meter.Fits(planned + price, left * sweep);
}

int StepPlanner::SweepsInPlace(int island) const {
  const int most = frame_->settings.max_sweeps, round = frame_->sweeps_of_round();
  if (!frame_->weighs_steps()) return most;
  // in whole rounds
  return most + (steps_->SweepsOfEffort(island, most) - most) / round * round;
}

int StepPlanner::MostSweeps(int island) const {
  const bool stepped = islands_->report(island).steps_accepted > 0;
  return stepped ? frame_->settings.max_sweeps : SweepsInPlace(island);
}

void StepPlanner::Learn() {
  for (int i = 0; i < islands_->count(); ++i) {
    const SweepRun& run = (*islands_)[i].run;
    const PlannedIsland& island = frame_->plan().islands()[i];
    if (island.first_body < 0) continue;
    StepOdds& odds = steps_->odds(i);
    odds.EndFrame(islands_->StepsTaken(i) > 0 ? island.bodies : 0,
                  Largest((*islands_)[i].seen, UnitOf(frame_->settings)),
                  frame_->problem.time_step);
    odds.EndSteps(islands_->report(i).steps_accepted > 0);
    if (!frame_->watches_gains()) continue;
    const int least = run.begin == 0 ? kLeastRun : kLeastRunAfterStep;
    const int sweeps = islands_->report(i).sweeps - run.begin;
    if (sweeps < least || run.start.sweeps == 0) continue;
    // the last sweeps are those that a step replaces; where they end in rounding all count
    const double energy = (*islands_)[i].seen.energy;
    odds.LearnSweeps(
        std::max(StepOdds::PowerOf(run.start.sweeps, sweeps, energy / run.start.energy),
                 StepOdds::PowerOf(run.quarter.sweeps, sweeps, energy / run.quarter.energy)));
  }
}

}  // namespace cairn
