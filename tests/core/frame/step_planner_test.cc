// SPDX-License-Identifier: MIT
// Which islands take a step between two rounds of sweeps.
#include "cycle/step_planner.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using test::Scene;

/// A tower and a single box, between two rounds of sweeps that left an error.
class BetweenRounds {
 public:
  explicit BetweenRounds(const Settings& settings)
      : BetweenRounds(settings, test::Together({test::Wall(1, 12), test::Wall(1, 1)})) {
    EXPECT_EQ(islands.count(), 2);
  }
  /// With what is remembered of the islands of others, and after a frame of another scene, if those
  /// are given.
  BetweenRounds(const Settings& settings, const Scene& scene, IslandMemories* memories = nullptr,
                const Scene* before = nullptr)
      : settings_(settings),
        scene_(scene),
        problem_(scene_.problem()),
        rows_(scene_.rows.size(), 0.0),
        memories_(memories != nullptr ? memories : &own_memories_) {
    if (before != nullptr) {
      std::vector<double> rows(before->rows.size());
      EXPECT_EQ(blocks_.Begin(before->problem(), 1, {.rows = rows}, &crew_), PackResult::kDone);
    }
    EXPECT_EQ(blocks_.Begin(problem_, 1, {.rows = rows_}, &crew_), PackResult::kDone);
    islands.Begin(blocks_.plan(), NoStep::kEnded);
    steps.Begin(frame_);
    planner.Begin(frame_, &steps, &islands);
    islands.groups()[0].sweeps = settings_.k_gs;
    for (int i = 0; i < islands.count(); ++i) islands[i].seen = {.max = 0.5, .energy = 1};
  }
  std::vector<int> Plan() {
    const std::span<const int> planned = planner.PlanRound();
    return {planned.begin(), planned.end()};
  }

 private:
  Settings settings_;
  Scene scene_;
  ContactProblem problem_;
  std::vector<double> rows_;
  Crew crew_{1};
  BlockFrame blocks_;
  IslandMemories own_memories_, *memories_;
  WorkPrices prices_;
  BudgetMeter meter_{settings_.budget, static_cast<double>(rows_.size()), &prices_};
  CycleFrame frame_{problem_, settings_, &blocks_, memories_, &meter_, &crew_};

 public:
  CycleIslands islands;
  BlockSteps steps;
  StepPlanner planner;
};

Settings WithPolicy(StepPolicy policy) {
  Settings settings;
  settings.step_policy = policy;
  settings.max_sweeps = 100;
  return settings;
}

using All = std::vector<int>;

// Two boxes fill no lanes, so that a row of theirs is dear. A tower that grows from them was never
// given a step, as its rows were thought to cost as much.
TEST(BlockSteps, GuessThePriceOfAnIslandByTheFactorOfASmallerOne) {
  const Settings settings = WithPolicy(StepPolicy::kWeighed);
  constexpr int kIsland[] = {0};
  IslandMemories memories;
  const auto price = [&](int boxes, bool guess) {
    BetweenRounds round(settings, test::Wall(1, boxes), &memories);
    if (!guess) round.steps.Analyse(0, kIsland);
    const double result = round.steps.PriceAlone(0, 0, 1, kInfinity);
    memories.EndFrame();
    return result;
  };
  const double small = price(2, false);
  const double guess = price(30, true), truth = price(30, false);
  EXPECT_GT(15 * small, 2.5 * truth);
  EXPECT_LT(guess, 1.5 * truth);
  EXPECT_GT(guess, truth / 1.5);
}

// To look at a graph of thousands of bodies takes longer than many a sweep.
TEST(BlockSteps, DoNotLookAtAGraphThatIsKnownToBeTooDear) {
  constexpr int kIsland[] = {0};
  IslandMemories memories;
  double price = 0;
  {
    BetweenRounds round(WithPolicy(StepPolicy::kWeighed), test::Wall(1, 30), &memories);
    round.steps.Analyse(0, kIsland);
    price = round.steps.PriceAlone(0, 0, 1, 0);
    memories.EndFrame();
  }
  const Scene other = test::Wall(1, 2);
  BetweenRounds round(WithPolicy(StepPolicy::kWeighed), test::Wall(1, 30), &memories, &other);
  EXPECT_EQ(round.steps.PriceAlone(0, 0, 1, 0.9 * price), price);
  EXPECT_GT(round.steps.Guess(0, kIsland), 0) << "the graph is not looked at";
  EXPECT_EQ(round.steps.PriceAlone(0, 0, 1, price), price);
  EXPECT_EQ(round.steps.Guess(0, kIsland), 0) << "it is known";
}

// What a step on one of several costs changes with those who share its group.
TEST(BlockSteps, LookAtTheGraphOfAGroupOfSeveralIslands) {
  constexpr int kIslands[] = {0, 1};
  IslandMemories memories;
  const Scene walls = test::Together({test::Wall(1, 12), test::Wall(1, 1)});
  const Scene other = test::Wall(1, 2);
  {
    BetweenRounds before(WithPolicy(StepPolicy::kWeighed), walls, &memories);
    before.steps.Analyse(0, kIslands);
    EXPECT_GT(before.steps.PriceAlone(0, 0, 1, 0), 0);
    memories.EndFrame();
  }
  BetweenRounds after(WithPolicy(StepPolicy::kWeighed), walls, &memories, &other);
  EXPECT_GT(after.steps.PriceAlone(0, 0, 1, 0), 0);
  EXPECT_EQ(after.steps.Guess(0, kIslands), 0) << "the graph is found again";
}

TEST(StepPlanner, AlwaysPlansStepsOnAllIslands) {
  BetweenRounds round(WithPolicy(StepPolicy::kAlways));
  EXPECT_EQ(round.Plan(), (All{0, 1}));
  EXPECT_EQ(round.Plan(), (All{0, 1})) << "planning alone changes nothing";
}

TEST(StepPlanner, LeavesIslandsAloneForARoundAfterAStepWasJudged) {
  BetweenRounds round(WithPolicy(StepPolicy::kAlways));
  round.islands[0].Step();
  EXPECT_EQ(round.Plan(), All{1});
  round.islands[0].Judge();
  EXPECT_EQ(round.Plan(), All{1});
  EXPECT_EQ(round.Plan(), (All{0, 1}));
}

TEST(StepPlanner, PlansNoStepWithoutSweepsAfterIt) {
  Settings settings = WithPolicy(StepPolicy::kAlways);
  settings.max_sweeps = settings.k_gs + 1;
  EXPECT_EQ(BetweenRounds(settings).Plan(), All{});
}

TEST(StepPlanner, PlansNoneWhereNoneAreAskedFor) {
  Settings settings = WithPolicy(StepPolicy::kAlways);
  settings.k_sm = 0;
  EXPECT_EQ(BetweenRounds(settings).Plan(), All{});
}

TEST(StepPlanner, SaysThatAStepDoesNotFitTheBudgetAndPlansNoMoreInTheFrame) {
  Settings settings = WithPolicy(StepPolicy::kAlways);
  settings.budget = Budget::Work(10);
  BetweenRounds round(settings);
  EXPECT_EQ(round.Plan(), All{});
  EXPECT_EQ(round.islands.report(0).no_step, NoStep::kTooDear);
  EXPECT_FALSE(round.islands[0].MayStep());
}

TEST(StepPlanner, WeighsStepsAgainstWhatIsLeftToDo) {
  BetweenRounds round(WithPolicy(StepPolicy::kWeighed));
  for (int i = 0; i < 2; ++i) round.islands[i].seen = {.max = 1e-6, .energy = 1e-6};
  EXPECT_EQ(round.Plan(), All{});
  EXPECT_EQ(round.islands.report(0).no_step, NoStep::kSweepsFaster) << "sweeps do the rest";

  for (int i = 0; i < 2; ++i) round.islands[i].seen = {.max = 0.5, .energy = 1};
  EXPECT_EQ(round.Plan(), All{0});
  EXPECT_EQ(round.islands.report(1).no_step, NoStep::kTooDear) << "a box takes few sweeps";
}

// Joints that stood open for long are not closed at once. Contacts are not kept from a step: what
// rocks would never get one again.
TEST(StepPlanner, MeetsNoLargeErrorOfJointsAtOnce) {
  for (const bool joints : {false, true}) {
    BetweenRounds round(WithPolicy(StepPolicy::kWeighed),
                        joints ? test::HangingChain(30, 1) : test::Wall(1, 30));
    EXPECT_EQ(round.Plan(), All{0}) << joints;
    round.islands[0].seen = {.max = 50, .energy = 100};
    EXPECT_EQ(round.Plan(), joints ? All{} : All{0});
    if (joints) {
      EXPECT_EQ(round.islands.report(0).no_step, NoStep::kSweepsFaster);
    }
  }
}

TEST(StepPlanner, PausesWhereStepsFailedOfLate) {
  BetweenRounds round(WithPolicy(StepPolicy::kWeighed));
  round.steps.Judge(0, false);
  EXPECT_EQ(round.Plan(), All{});
  EXPECT_EQ(round.islands.report(0).no_step, NoStep::kPaused);
}

TEST(StepPlanner, MakesMoreSweepsInPlaceOfStepsInWholeRounds) {
  const BetweenRounds weighed(WithPolicy(StepPolicy::kWeighed));
  const int more = weighed.planner.SweepsInPlace(0) - 100;
  EXPECT_GT(more, 0);
  EXPECT_EQ(more % Settings{}.k_gs, 0);
  const BetweenRounds always(WithPolicy(StepPolicy::kAlways));
  EXPECT_EQ(always.planner.SweepsInPlace(0), 100);
}

}  // namespace
}  // namespace cairn
