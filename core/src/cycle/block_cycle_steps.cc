// SPDX-License-Identifier: MIT
// Subspace steps of BlockCycle: where, and whether they are kept.
#include <algorithm>
#include <span>
#include <utility>

#include "cycle/block_cycle.h"

namespace cairn {
namespace {

/// A step that brought the residual down to this share, and phi down, is kept without trying sweeps
/// alone: that trial costs as much as the sweeps of the step do.
constexpr double kSureGain = 0.7;
/// What fewer sweeps gain says too little; after a step, whose trace they carry, even more so.
constexpr int kLeastRun = 9, kLeastRunAfterStep = 30;
/// A step that is weighed costs at most this share of all else on its island, as prices have it:
/// those of steps in doubles are a third too high.
constexpr double kMostOfRest = 1.25;
/// And all of it together so many times what sequential impulses row by row do.
constexpr double kMostOfScalar = 2.2;
/// By so much more where there was a step in the last frame: steps that come and go do harm.
/// Without joints that is for one factorisation.
constexpr double kSlack = 1.5;
/// From which Body::strain on sweeps leave joints that part before they pull, whatever a step costs
/// in terms of row by row. From half of it on dolls would be a fifth dearer.
constexpr double kStrained = 1;
/// Within so many tolerances sweeps do the rest.
constexpr double kNear = 10;
/// Error that a step meets at most where there was none in the last frame [m/s] or [rad/s].
constexpr double kMostThrown = 1;
/// The same where it is strained: what waits longer parts further.
constexpr double kMostThrownStrained = 3;
/// What measuring a step and undoing it costs, in sweeps.
constexpr double kJudgingSweeps = 2;
/// What costs more sweeps than this is not tried.
constexpr double kMostSweeps = 1000;

}  // namespace

bool BlockCycle::IsSure(int i) {
  if (weighs_ && steps_.odds(i).wants_trial()) return false;
  return with_step_[i].energy <= kSureGain * before_[i].energy && GainOfStep(i) >= 0;
}

void BlockCycle::FindCandidates() {
  const int left = settings_->max_sweeps - SweepsMade();
  if (!steps_.asked() || left < std::min(settings_->k_gs, kLeastSweepsAfterStep)) return;
  const Plan& plan = frame_->plan();
  PlannedSteps planned;
  for (int g = 0; g < static_cast<int>(made_.size()); ++g) {
    const Group& group = plan.groups()[g];
    const size_t first = stepped_islands_.size();
    for (int i : plan.islands_of_groups().subspan(group.first_island, group.islands)) {
      if (std::exchange(states_[i].rests, false) || Done(i) || states_[i].too_late) continue;
      if (plan.islands()[i].first_body < 0) continue;
      NoStep no_step = steps_.Due(i) ? NoStep::kEnded : NoStep::kPaused;
      if (no_step == NoStep::kEnded && weighs_) no_step = Weigh(g, i);
      if (no_step == NoStep::kEnded) stepped_islands_.push_back(i);
      islands_[i].no_step = no_step;
    }
    if (stepped_islands_.size() == first) continue;

    const auto islands = std::span(stepped_islands_).subspan(first);
    const NoStep refused = PlanStep(g, islands, &planned);
    if (refused == NoStep::kEnded) {
      if (weighs_) KeepWorthwhile(g, first);
      continue;
    }
    // there is never more left of a budget; the next frame has its own
    for (int i : islands) {
      states_[i].too_late = true;
      islands_[i].no_step = refused;
      if (!watches_) steps_.Postpone(i);
    }
    stepped_islands_.resize(first);
  }
}

NoStep BlockCycle::PlanGraph(int g, std::span<const int> islands, const PlannedSteps& planned) {
  const double guess = steps_.Guess(g, islands);
  if (guess == 0) return NoStep::kEnded;
  const auto pays = [&](double price) { return StepPays(g, islands, planned.steps, price); };
  if (!meter_->Fits(planned.steps + guess, planned.sweeps)) return NoStep::kTooDear;
  if (!pays(guess)) return NoStep::kSweepsFaster;
  const auto analysis = steps_.PriceOfAnalysis(g, islands);
  if (analysis.whole > 0) {
    // where the step does not fit any more after it, it will in the next frame
    if (!meter_->FitsAnalysis(analysis.whole, planned.steps, planned.sweeps)) {
      return NoStep::kTooDear;
    }
    if (!pays(guess + analysis.of_step)) return NoStep::kSweepsFaster;
    steps_.Analyse(g, islands);
  }
  return NoStep::kEnded;
}

NoStep BlockCycle::PlanStep(int g, std::span<const int> islands, PlannedSteps* planned) {
  // after the step its sweeps, and, where that is not foreseen, as many without it
  const int left = settings_->max_sweeps - SweepsMade();
  const double sweeps =
      (watches_ ? 1.0 : 2.0) * std::min(settings_->k_gs, left) + 2 * BlockSweeps::kMeasureSweeps;
  const double rows = static_cast<double>(frame_->plan().groups()[g].rows);
  // what a sweep costs does not depend on how full the lanes are, so that an island does not see
  // who shares them
  const double lanes = static_cast<double>(simd::kLanes) * frame_->plan().groups()[g].x_lines;
  const PlannedSteps before{planned->steps, planned->sweeps + sweeps * rows};
  if (const NoStep refused = PlanGraph(g, islands, before); refused != NoStep::kEnded) {
    return refused;
  }
  // as many factorisations as fit, and half of them where they do not
  const bool always = settings_->step_policy == StepPolicy::kAlways;
  NoStep refused = NoStep::kTooDear;
  for (int most = settings_->k_sm; most > 0; most /= 2) {
    const double price = steps_.Price(g, islands, most);
    if (!always && price > kMostSweeps * lanes) continue;
    if (!meter_->Fits(before.steps + price, before.sweeps)) continue;
    refused = NoStep::kSweepsFaster;
    if (!StepPays(g, islands, before.steps, price)) continue;
    for (int i : islands) steps_.Limit(i, most);
    *planned = {before.steps + price, before.sweeps};
    return NoStep::kEnded;
  }
  return refused;
}

NoStep BlockCycle::Weigh(int g, int i) {
  const StepOdds& odds = steps_.odds(i);
  const Residual& seen = states_[i].seen;
  const double largest = Largest(seen);
  const bool near = largest <= kNear * settings_->tolerance;
  // what sweeps have left unsolved for long, a single step would throw
  const int bodies = frame_->plan().islands()[i].bodies;
  const bool strained = steps_.strain(i) > kStrained;
  const bool thrown =
      !odds.stepped_most(bodies) && largest > (strained ? kMostThrownStrained : kMostThrown);
  if (near || thrown || !(odds.pays() || odds.wants_trial())) return NoStep::kSweepsFaster;
  const double rest = steps_.RestAlone(i, settings_->max_sweeps);
  const double scalar = steps_.ScalarAlone(i, settings_->max_sweeps);
  const double most_price =
      strained ? kMostOfRest * rest : std::min(kMostOfRest * rest, kMostOfScalar * scalar - rest);
  const auto fits = [&](int factorisations) {
    const bool slack = odds.stepped() && (factorisations == 1 || steps_.HasJoints(i));
    return steps_.PriceAlone(g, i, factorisations) <= (slack ? kSlack : 1) * most_price;
  };
  int most = settings_->k_sm;
  while (most > 0 && !fits(most)) most /= 2;
  steps_.Limit(i, most);
  return most > 0 ? NoStep::kEnded : NoStep::kTooDear;
}

void BlockCycle::KeepWorthwhile(int g, size_t first) {
  // their graphs are known now
  const auto islands = stepped_islands_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto refused = std::remove_if(islands, stepped_islands_.end(), [this, g](int i) {
    islands_[i].no_step = Weigh(g, i);
    return islands_[i].no_step != NoStep::kEnded;
  });
  stepped_islands_.erase(refused, stepped_islands_.end());
}

bool BlockCycle::StepPays(int g, std::span<const int> islands, double planned, double price) {
  if (!watches_) return true;
  const bool first = std::all_of(islands.begin(), islands.end(), [&](int i) {
    return steps_.odds(i).carries() && StepsTaken(i) == 0 && !steps_.odds(i).stale();
  });
  if (first) return true;
  double cut = 0, power = 0;
  int sweeps = settings_->max_sweeps;
  for (int i : islands) {
    const StepOdds& odds = steps_.odds(i);
    if (odds.stale()) return false;
    cut += odds.cut(StepsTaken(i));
    power += odds.power();
    sweeps = std::min(sweeps, SweepsMade() - states_[i].run_begin);
  }
  if (cut <= 0) return false;
  // of what is left each group has its share
  const double all_rows = ActiveRows();
  const double shares = all_rows / static_cast<double>(frame_->plan().groups()[g].rows);
  const double sweep = all_rows * (1 + (accelerates_ ? Nncg::kSweeps : 0));
  const double smoothing = settings_->k_gs + 2 * BlockSweeps::kMeasureSweeps;
  const double prices = StepOdds::PricesLeft(cut / power);
  if (meter_->Fits(prices * shares * price, (prices * smoothing - sweeps) * sweep)) return true;
  // where sweeps have another limit than the budget, a step takes nothing from them
  const double left = settings_->max_sweeps - SweepsMade();
  return meter_->Fits(planned + price, left * sweep);
}

int BlockCycle::StepsTaken(int island) const {
  return islands_[island].steps_accepted + islands_[island].steps_restored;
}

void BlockCycle::BeginRun(int island, int begin) {
  IslandState& state = states_[island];
  state.run_begin = begin;
  state.start = state.quarter = state.half = {SweepsMade() - begin, state.seen.energy};
}

void BlockCycle::MarkRuns() {
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (!Open(i)) continue;
    IslandState& state = states_[i];
    const int sweeps = SweepsMade() - state.run_begin;
    if (state.half.sweeps == 0) {
      BeginRun(i, 0);
    } else if (sweeps >= 2 * state.half.sweeps) {
      state.quarter = std::exchange(state.half, {sweeps, state.seen.energy});
    }
  }
}

void BlockCycle::Learn() {
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    const IslandState& state = states_[i];
    if (frame_->plan().islands()[i].first_body < 0) continue;
    StepOdds& odds = steps_.odds(i);
    odds.EndFrame(StepsTaken(i) > 0 ? frame_->plan().islands()[i].bodies : 0);
    if (!watches_) continue;
    const int least = state.run_begin == 0 ? kLeastRun : kLeastRunAfterStep;
    const int sweeps = islands_[i].sweeps - state.run_begin;
    if (sweeps < least || state.start.sweeps == 0) continue;
    // the last sweeps are those that a step replaces; where they end in rounding all count
    const double energy = state.seen.energy;
    odds.LearnSweeps(
        std::max(StepOdds::PowerOf(state.start.sweeps, sweeps, energy / state.start.energy),
                 StepOdds::PowerOf(state.quarter.sweeps, sweeps, energy / state.quarter.energy)));
  }
}

void BlockCycle::TakeSteps() {
  FindCandidates();
  if (stepped_islands_.empty()) return;
  ChooseNone();
  for (int i : stepped_islands_) Choose(i);
  if (guards_) steps_.FindBefore();
  MeasureChosen(&before_);
  merits_before_.Find(frame_, chosen_);
  SetJudgingAside();

  // islands of a group follow each other
  const Plan& plan = frame_->plan();
  const std::span<const int> all = stepped_islands_;
  for (size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    const int group = plan.islands()[all[begin]].group;
    while (end < all.size() && plan.islands()[all[end]].group == group) ++end;
    const std::span<const int> islands = all.subspan(begin, end - begin);
    for (int i : islands) before_steps_.Take(plan, i, frame_->blocks());
    steps_.Take(group, islands);
    for (int i : islands) {
      nncg_.Forget(i);
      islands_[i].factorisations += steps_.result(i).factorisations;
      islands_[i].step_work += static_cast<std::int64_t>(steps_.work(i));
      states_[i].stepped = steps_.result(i).solved;
    }
  }
  std::erase_if(stepped_islands_, [this](int i) {
    if (states_[i].stepped) return false;
    if (steps_.given_up(i)) {
      states_[i].too_late = true;
      islands_[i].no_step = NoStep::kTooDear;
      return true;
    }
    steps_.Judge(i, false);
    ++islands_[i].steps_restored;
    return true;
  });
  if (stepped_islands_.empty()) meter_->SetAside(0);
}

void BlockCycle::KeepBetterSteps(int sweeps) {
  if (stepped_islands_.empty()) return;
  ChooseNone();
  for (int i : stepped_islands_) Choose(i);
  meter_->SetAside(0);
  MeasureChosen(&with_step_);
  FindHarm();
  ChooseNone();
  bool sure = true;
  for (int i : stepped_islands_) {
    states_[i].better_alone = false;
    if (!states_[i].harmful && IsSure(i)) continue;
    Choose(i);
    sure = false;
  }
  if (!sure && meter_->out_of_time()) {
    CompareWithBefore();
  } else if (!sure) {
    TryWithoutSteps(sweeps);
  }

  for (int i : stepped_islands_) {
    const bool accepted = !states_[i].better_alone;
    if (watches_ && sweeps >= kLeastSweepsAfterStep && before_[i].energy > 0) {
      steps_.odds(i).LearnStep(StepsTaken(i), with_step_[i].energy / before_[i].energy);
    }
    if (accepted) BeginRun(i, SweepsMade() - sweeps);
    if (!accepted) nncg_.Forget(i);
    if (states_[i].harmful) {
      islands_[i].guards.step = true;
      steps_.Guarded(i);
    }
    steps_.Judge(i, accepted);
    ++(accepted ? islands_[i].steps_accepted : islands_[i].steps_restored);
    states_[i].stepped = false;
    states_[i].rests = true;
  }
  stepped_islands_.clear();
}

double BlockCycle::GainOfStep(int i) const {
  return merits_before_.of(i).value() - merits_.of(i).value();
}

double BlockCycle::GainAlone(int i) const {
  return merits_before_.of(i).value() - alone_merits_.of(i).value();
}

bool BlockCycle::IsBetterAlone(int i) {
  if (IsSure(i)) return false;
  const StepTrial trial{.with_step = with_step_[i].energy,
                        .alone = alone_[i].energy,
                        .closer = GainOfStep(i) > GainAlone(i)};
  return trial.is_better_alone();
}

void BlockCycle::FindHarm() {
  merits_.Find(frame_, chosen_);
  if (!guards_) return;
  steps_.FindAfter();
  for (int i : stepped_islands_) {
    const double error = Largest(before_[i]);
    states_[i].harmful = merits_.of(i).is_worse_than_none() ||
                         IsTooMuch(steps_.result(i).joint_speed) ||
                         IsTooViolent(merits_before_.of(i), merits_.of(i), steps_.mass(i), error) ||
                         IsFlung(steps_.before(i), steps_.after(i), steps_.mass(i), error);
  }
}

void BlockCycle::SetJudgingAside() { meter_->SetAside(kJudgingSweeps * RowsOf(chosen_)); }

void BlockCycle::CompareWithBefore() {
  for (int i : stepped_islands_) {
    if (!Chosen(i)) continue;
    const StepTrial trial{
        .with_step = with_step_[i].energy, .alone = before_[i].energy, .closer = GainOfStep(i) > 0};
    states_[i].better_alone = states_[i].harmful || (!IsSure(i) && trial.is_better_alone());
    if (states_[i].better_alone) before_steps_.Restore(frame_->plan(), i, &frame_->blocks());
  }
}

void BlockCycle::TryWithoutSteps(int sweeps) {
  // the same number of sweeps from before the steps, as far as the budget goes
  const Plan& plan = frame_->plan();
  BlockData* const blocks = &frame_->blocks();
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (!Chosen(i)) continue;
    after_steps_.Take(plan, i, *blocks);
    states_[i].seen_with_step = states_[i].seen;
    if (states_[i].stepped) before_steps_.Restore(plan, i, blocks);
  }
  for (size_t g = 0; g < chosen_.size(); ++g) {
    chosen_[g].sweeps = std::max(0, made_[g].sweeps - sweeps);
  }
  SetJudgingAside();
  if (sweeps_->Sweep(sweeps, chosen_) && sweeps > 0) See(chosen_);
  meter_->SetAside(0);
  MeasureChosen(&alone_);
  alone_merits_.Find(frame_, chosen_);
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    if (!Chosen(i)) continue;
    states_[i].better_alone = states_[i].stepped && (states_[i].harmful || IsBetterAlone(i));
    if (states_[i].stepped && Learns())
      steps_.odds(i).LearnGains(GainOfStep(i), GainAlone(i),
                                SweepsInPlace(i) > settings_->max_sweeps);
    if (states_[i].better_alone) continue;
    states_[i].seen = states_[i].seen_with_step;
    after_steps_.Restore(plan, i, blocks);
  }
}

}  // namespace cairn
