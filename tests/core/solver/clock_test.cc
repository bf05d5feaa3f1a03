// SPDX-License-Identifier: MIT
// What clocks do to a Solve() under Budget::Time: those that jump, stand still, or end a frame
// anywhere.
#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "runtime/budget.h"
#include "tests/core/support/block_problems.h"
#include "tests/core/support/test_clock.h"

namespace cairn {
namespace {

using std::chrono::hours;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using test::Scene;
using test::ScriptedClock;
using test::Solution;

Scene TowersAndChains() {
  return test::Together({test::Tower(4), test::HangingChain(6, 9), test::Wall(4, 4)});
}

Settings TimedSteps(const Clock* clock) {
  Settings settings = test::ColouredSteps(60);
  settings.budget = Budget::Time(milliseconds(1));
  settings.tuning.min_sweeps = Tuning::kByBudget;
  settings.tuning.clock = clock;
  return settings;
}

/// What became of a frame whose time is up from one look at the clock on.
struct Ended {
  Solution solution;
  int looks_after = 0;  ///< with time up
};

Ended EndAt(int look, const Scene& scene) {
  ScriptedClock clock([look](int now) { return now == look ? hours(1) : nanoseconds(0); });
  Ended ended{test::Solve(TimedSteps(&clock), scene)};
  ended.looks_after = clock.looks() - look;
  return ended;
}

// A clock that stands still, and jumps beyond the budget at every look in turn: between sweeps, in
// the middle of one, in a factorisation, while a step is judged.
TEST(Clock, MayEndAFrameAnywhereAndItIsMadeAgain) {
  const Scene scene = TowersAndChains();
  const int looks = EndAt(-1, scene).looks_after - 1;
  ASSERT_GT(looks, 100);
  int given_up = 0, stepped = 0;
  for (int look = 1; look < looks && !testing::Test::HasFailure(); ++look) {
    SCOPED_TRACE(look);
    const Ended ended = EndAt(look, scene);
    const Report& report = ended.solution.report;
    ASSERT_TRUE(report.ok());
    EXPECT_GE(report.sweeps, Tuning::kLateSweeps);
    // one for each of the least sweeps, and some to measure and to write
    EXPECT_LE(ended.looks_after, 40);
    (report.factorisations > 0 ? stepped : given_up) += 1;

    Settings again = TimedSteps(nullptr);
    again.budget = Budget::Unlimited();
    again.tuning.replay = &report.replay;
    const Solution replayed = test::Solve(again, scene);
    EXPECT_TRUE(test::SameBits(replayed, ended.solution));
    EXPECT_EQ(replayed.report.work, report.work);
    EXPECT_EQ(replayed.report.stop, report.stop);
    EXPECT_EQ(replayed.report.factorisations, report.factorisations);
  }
  EXPECT_GT(given_up, 20) << "frames that end in their first step, or before it";
  EXPECT_GT(stepped, 20);
}

// As if it had never begun: no impulse changed, and nothing but its price was learnt.
TEST(Clock, ThatEndsAStepLeavesWhatSweepsMade) {
  const Scene scene = test::Tower(6);
  const Solution plain = test::Solve(test::Coloured(5), scene);
  int given_up = 0;
  for (int look = 1; look < 60; ++look) {
    Settings settings = TimedSteps(nullptr);
    settings.acceleration = Acceleration::kNone;
    ScriptedClock clock([look](int now) { return now == look ? hours(1) : nanoseconds(0); });
    settings.tuning.clock = &clock;
    const Solution s = test::Solve(settings, scene);
    if (s.report.sweeps != 5 || s.report.factorisations > 0) continue;
    EXPECT_TRUE(test::SameBits(s, plain)) << look;
    const auto& fits = s.report.replay.fits;
    // the step was given up, and then it was late
    const bool as_answered = fits.size() >= 2 && fits[fits.size() - 2] == 0 && fits.back() == 1;
    given_up += s.report.islands[0].step_work > 0 && as_answered ? 1 : 0;
  }
  EXPECT_GT(given_up, 3);
}

TEST(Clock, ThatStandsStillLeavesTheEndToTheSweepLimit) {
  const Scene scene = TowersAndChains();
  const ScriptedClock still = test::TickingClock(nanoseconds(0));
  Solver solver(TimedSteps(&still));
  for (int frame = 0; frame < 20; ++frame) {
    const Report report = test::Solve(&solver, scene).report;
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.stop, StopReason::kSweepLimit);
  }
  // when it goes on again, so do budgets
  const ScriptedClock clock = test::TickingClock(microseconds(20));
  solver.settings().tuning.clock = &clock;
  solver.settings().max_sweeps = 1'000'000;
  int last = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const int before = clock.looks();
    const Report report = test::Solve(&solver, scene).report;
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.stop, StopReason::kTimeSpent);
    last = clock.looks() - before;
  }
  EXPECT_LE(last, 50 + 20) << "looks in 1 ms of 20 us each, and some to end it";
}

TEST(Clock, ThatJumpsBackIsTakenToStandStill) {
  const Scene scene = TowersAndChains();
  for (int look = 0; look < 120; look += 7) {
    SCOPED_TRACE(look);
    // 1 us a look, but for one hour back
    const ScriptedClock clock([look](int now) -> nanoseconds {
      return now == look ? nanoseconds(-hours(1)) : nanoseconds(microseconds(1));
    });
    Solver solver(TimedSteps(&clock));
    const Report first = test::Solve(&solver, scene).report;
    ASSERT_TRUE(first.ok());
    EXPECT_GE(first.elapsed, nanoseconds(0));
    EXPECT_GE(first.step_time, nanoseconds(0));
    EXPECT_LE(first.sweeps, 60);
    // the next frame knows nothing of it
    const int before = clock.looks();
    const Report next = test::Solve(&solver, scene).report;
    ASSERT_TRUE(next.ok());
    EXPECT_GT(next.elapsed, nanoseconds(0));
    EXPECT_LE(clock.looks() - before, 1200);
  }
}

TEST(Clock, IsNotReadWithoutABudgetOfTime) {
  const Scene scene = TowersAndChains();
  const ScriptedClock clock = test::TickingClock(microseconds(1));
  for (const Budget& budget : {Budget::Unlimited(), Budget::Work(10'000)}) {
    Settings settings = TimedSteps(&clock);
    settings.budget = budget;
    const Solution with = test::Solve(settings, scene);
    settings.tuning.clock = nullptr;
    EXPECT_TRUE(test::SameBits(with, test::Solve(settings, scene)));
  }
  EXPECT_EQ(clock.looks(), 0);
}

// The prices of one meter, by hand.
TEST(Meter, LearnsNothingWorseThanItsFloorFromAClockThatStandsStill) {
  WorkPrices prices;
  const ScriptedClock still = test::TickingClock(nanoseconds(0));
  for (int i = 0; i < 1000; ++i) {
    BudgetMeter meter(Budget::Time(milliseconds(1)), 100, &prices, &still);
    meter.Begin();
    meter.Charge(WorkKind::kSweep, 100);
    meter.ChargeFinish();
  }
  EXPECT_GT(prices.sweep_ns, 0.04);
  EXPECT_GT(prices.finish_ns, 0.04);
}

TEST(Meter, SetsTimeAsideForResultsAtOnceAndForgetsItSlowly) {
  WorkPrices prices;
  const auto finish = [&](nanoseconds took) {
    const ScriptedClock clock = test::TickingClock(took);
    BudgetMeter meter(Budget::Time(hours(1)), 1000, &prices, &clock);
    meter.ChargeFinish();
  };
  finish(microseconds(15));
  EXPECT_NEAR(prices.finish_ns, 15, 1e-9);
  finish(microseconds(50));
  EXPECT_NEAR(prices.finish_ns, 30, 1e-9);
  finish(microseconds(900));  // was preempted, perhaps
  EXPECT_NEAR(prices.finish_ns, 37.5, 1e-9);
  finish(microseconds(10));
  EXPECT_NEAR(prices.finish_ns, 37.5 - 0.02 * 27.5, 1e-9);
}

TEST(Meter, IsLateWhereWhatIsSetAsideLeavesNothing) {
  WorkPrices prices{.sweep_ns = 10, .finish_ns = 0};
  const ScriptedClock still = test::TickingClock(nanoseconds(0));
  Replay record;
  BudgetMeter meter(Budget::Time(microseconds(1)), 1, &prices, &still);
  meter.Record(&record);
  EXPECT_FALSE(meter.Late(99));
  EXPECT_TRUE(meter.Late(100));
  meter.SetAside(60);
  EXPECT_FALSE(meter.Late(39));
  EXPECT_TRUE(meter.Late(40));
  meter.SetAside(0);
  EXPECT_FALSE(meter.Late(99));
  EXPECT_FALSE(meter.spent()) << "nothing was done";
  EXPECT_EQ(record.fits, (Array<std::uint8_t>{0, 1, 0, 1, 0}));

  // again, without a clock
  BudgetMeter again(record, &prices);
  for (const bool late : {false, true, false, true, false, false}) EXPECT_EQ(again.Late(1), late);
  // other budgets are never late
  BudgetMeter work(Budget::Work(1), 1, &prices);
  EXPECT_FALSE(work.Late(1e9));
}

TEST(Meter, GivesStepsAllTheTimeThatThereIs) {
  WorkPrices prices;
  for (const nanoseconds start :
       {nanoseconds(5), nanoseconds(0), -nanoseconds(std::chrono::hours(1))}) {
    const ScriptedClock clock([start](int look) { return start + microseconds(look); });
    const BudgetMeter meter(Budget::Time(nanoseconds::max()), 1, &prices, &clock);
    EXPECT_FALSE(meter.StepDeadline().Pass());
  }
}

TEST(Meter, LearnsOfAStepThatWasGivenUpWhatItTakesAtLeast) {
  WorkPrices prices{.step_ns = 1, .can_give_up_steps = true};
  const ScriptedClock clock = test::TickingClock(microseconds(100));
  BudgetMeter meter(Budget::Time(microseconds(150)), 0, &prices, &clock);
  meter.Begin();
  meter.ChargeStep(50'000, true);
  EXPECT_NEAR(prices.step_ns, 2, 1e-9) << "100 us for what was to take 50";
  EXPECT_FALSE(prices.step_known);
  EXPECT_TRUE(meter.out_of_time());
}

}  // namespace
}  // namespace cairn
