// SPDX-License-Identifier: MIT
// Budgets: what they cost at most, that a spent one leaves a feasible answer, and that work is time
// without a clock.
#include "cairn/budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "reference/step_price.h"
#include "tests/core/support/dense.h"
#include "tests/core/support/packed.h"
#include "tests/core/support/problems.h"
#include "tests/core/support/test_clock.h"

namespace cairn {
namespace {

using std::chrono::nanoseconds;
using test::Scene;
using test::Solution;

/// Rows between two looks at the budget (kBlockRows, island_cycle.cc).
constexpr int kBlock = 256;
/// The same in blocks: a claim of a thread (kUnitRows, plan_stages.cc) and the rest of its last
/// block.
constexpr int kUnit = 2048;

/// One island of 720 rows, so that blocks end inside sweeps and between normals and their friction.
Scene BigPile(std::uint64_t seed) {
  const Scene scene =
      test::RandomPile({.bodies = 12, .contacts = 220, .pins = 20, .world_share = 0.2}, seed);
  EXPECT_EQ(FindIslands(scene.problem()).size(), 1u);
  return scene;
}

Settings Within(Settings settings, Budget budget) {
  settings.budget = budget;
  return settings;
}

void ExpectFeasible(const Scene& scene, const Solution& s) {
  const Eigen::VectorXd x = test::ToVector(s.x);
  for (int i = 0; i < x.size(); ++i) ASSERT_EQ(x[i], test::Project(scene, x, i, x[i])) << i;
}

TEST(Work, OfPlainSweepsExceedsTheBudgetByLessThanABlock) {
  const Scene scene = BigPile(1);
  for (int work = 1; work < 4000; work += 37) {
    const Report report =
        test::Solve(Within(test::PlainSweeps(1000), Budget::Work(work)), scene).report;
    EXPECT_GE(report.work, work);
    EXPECT_LT(report.work, work + kBlock);
    EXPECT_EQ(report.stop, StopReason::kWorkSpent);
    EXPECT_EQ(report.sweeps, report.work / 720) << "whole sweeps only";
  }
}

/// Units of the dearest step of any island with both kinds of sweeps after it, and two residuals.
double DearestStep(const Scene& scene, const Settings& settings) {
  const Packer packer(scene.problem(), settings);
  double dearest = 0;
  for (const Island& island : FindIslands(scene.problem())) {
    const PackedIsland packed = packer.Pack(island);
    IslandMemory memory;
    WorkPrices prices;
    BudgetMeter meter(Budget::Unlimited(), 0, &prices);
    EXPECT_TRUE(StepPays(packed, settings, {&meter, 0}, &memory));
    const double sweeps = 2 * (settings.k_gs + 0.5) * static_cast<double>(packed.rows.size());
    dearest =
        std::max(dearest, StepCost(packed, settings, settings.k_sm, SystemOf(&memory)) + sweeps);
  }
  return dearest;
}

// Looking at the residual is half a sweep in one piece: 360 rows here. A single island starts a
// step only if all of it fits, so nothing is added to that.
TEST(Work, OfStepsOnOneIslandExceedsTheBudgetByABlockAndALookAtTheResidual) {
  const Scene scene = BigPile(1);
  int steps = 0;
  for (int work = 1; work < 60000; work += 977) {
    const Report report =
        test::Solve(Within(test::AlwaysSteps(1000), Budget::Work(work)), scene).report;
    EXPECT_LE(report.work, work + kBlock + 720 / 2);
    steps += report.steps_accepted + report.steps_restored;
  }
  EXPECT_GT(steps, 20);
}

// Islands take turns: when a planned step begins, others may have used what it was to cost.
TEST(Work, OfManyIslandsExceedsTheBudgetByOnePlannedStep) {
  Scene scene = test::Tower(12);
  for (int copy = 1; copy < 6; ++copy) {
    for (Row row : test::Tower(12).rows) {
      row.body_a += 12 * copy;
      if (row.body_b != kWorld) row.body_b += 12 * copy;
      if (row.parent != kNoRow) row.parent += 144 * copy;
      scene.rows.push_back(row);
    }
    const Scene tower = test::Tower(12);
    scene.bodies.insert(scene.bodies.end(), tower.bodies.begin(), tower.bodies.end());
  }
  const Settings settings = test::AlwaysSteps(1000);
  const double step = DearestStep(scene, settings);
  for (int work = 1; work < 100000; work += 1777) {
    const Report report = test::Solve(Within(settings, Budget::Work(work)), scene).report;
    EXPECT_LE(static_cast<double>(report.work), work + std::max<double>(kBlock, step));
  }
}

// Stopped anywhere in a sweep, also where a normal was relaxed and its friction was not yet.
TEST(Work, WhereverItEndsImpulsesAreFeasibleAndVelocitiesBelongToThem) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Scene scene = BigPile(seed);
    const test::Dense dense = test::MakeDense(scene);
    for (const Settings& settings : {test::PlainSweeps(100), test::AlwaysSteps(100)}) {
      for (int work = 0; work < 5000; work += 256) {
        const Solution s = test::Solve(Within(settings, Budget::Work(work)), scene);
        ExpectFeasible(scene, s);
        const Eigen::VectorXd v =
            dense.free + dense.inverse_mass * (dense.J.transpose() * test::ToVector(s.x));
        EXPECT_LT((test::Flatten(s.v) - v).cwiseAbs().maxCoeff(), 1e-10);
      }
    }
  }
}

TEST(Work, GivesTheSameBitsTwice) {
  const Scene scene = BigPile(2);
  for (int work : {100, 3000, 30000}) {
    const Settings settings = Within(test::AlwaysSteps(1000), Budget::Work(work));
    const Solution first = test::Solve(settings, scene), second = test::Solve(settings, scene);
    EXPECT_TRUE(test::SameBits(first, second));
    EXPECT_EQ(first.report.work, second.report.work);
    EXPECT_GT(first.report.elapsed, nanoseconds(0));
  }
}

// Each relaxation of a row minimises phi(x) = x' A x / 2 - b' x along it, so without friction more
// work never leaves phi higher. (The natural residual has no such law: it may grow from one sweep
// to the next, and so may phi where friction moves the bounds.)
TEST(Work, MoreOfItNeverLeavesMoreEnergyWithoutFriction) {
  Scene scene = BigPile(3);
  for (Row& row : scene.rows) {
    if (row.parent != kNoRow) row.lo = 0;
    row.parent = kNoRow;
  }
  const test::Dense dense = test::MakeDense(scene);
  double before = 0;  // of x = 0
  for (int work = 0; work < 20000; work += kBlock) {
    const Solution s = test::Solve(Within(test::PlainSweeps(1000), Budget::Work(work)), scene);
    const Eigen::VectorXd x = test::ToVector(s.x);
    const double phi = x.dot(0.5 * (dense.A * x) - dense.b);
    EXPECT_LE(phi, before + 1e-12 * std::abs(before)) << work;
    before = phi;
  }
  EXPECT_LT(before, -1);
}

// Nothing may be started: what comes back is the start, brought inside its bounds. This one is
// rotten, so it is left alone by plain methods only; see Guards.
TEST(Budget, OfNothingGivesTheProjectedWarmStart) {
  const Scene scene = BigPile(4);
  test::Random random(4);
  std::vector<double> start(scene.rows.size());
  for (double& x : start) x = random.Uniform(-1, 1);
  Eigen::VectorXd expected = test::ToVector(start);
  for (int i = 0; i < expected.size(); ++i) {
    expected[i] = test::Project(scene, expected, i, expected[i]);
  }
  const test::Dense dense = test::MakeDense(scene);
  const Eigen::VectorXd v = dense.free + dense.inverse_mass * (dense.J.transpose() * expected);
  for (const Budget& nothing : {Budget::Work(0), Budget::Time(nanoseconds(0))}) {
    const Solution s = test::Solve(
        Within({.method = Method::kPgs, .path = Path::kReference, .tuning = {.min_sweeps = 0}},
               nothing),
        scene, start);
    EXPECT_EQ(test::ToVector(s.x), expected);
    EXPECT_LT((test::Flatten(s.v) - v).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(s.report.sweeps, 0);
    EXPECT_EQ(s.report.work, 0);
    const Report measured = Measure(scene.problem(), s.x);
    EXPECT_NEAR(s.report.residual_max, measured.residual_max, 1e-12);
  }
}

// Two islands: neither is left out because the other was first.
TEST(Budget, OfNothingStillMakesTheSweepsThatAreMadeInAnyCase) {
  const Scene scene = test::RandomPile({.bodies = 30, .contacts = 30}, 7);
  ASSERT_GT(FindIslands(scene.problem()).size(), 1u);
  for (int sweeps : {1, 3, 7}) {
    const Solution expected = test::Solve(test::PlainSweeps(sweeps), scene);
    for (const Budget& nothing : {Budget::Work(0), Budget::Time(nanoseconds(0))}) {
      Settings settings = Within(test::AlwaysSteps(100), nothing);
      settings.tuning.min_sweeps = sweeps;
      const Solution s = test::Solve(settings, scene);
      EXPECT_TRUE(test::SameBits(s, expected)) << sweeps;
      EXPECT_EQ(s.report.sweeps, sweeps);
    }
  }
}

// More than max_sweeps are not made, whatever min_sweeps says.
TEST(Budget, OfNothingMakesNoMoreThanMaxSweeps) {
  const Scene scene = BigPile(8);
  Settings settings = Within(test::PlainSweeps(2), Budget::Work(0));
  settings.tuning.min_sweeps = 5;
  EXPECT_EQ(test::Solve(settings, scene).report.sweeps, 2);
}

TEST(Budget, ThatIsNeverSpentChangesNothing) {
  const Scene scene = BigPile(5);
  for (const Settings& settings : {test::PlainSweeps(60), test::AlwaysSteps(60)}) {
    const Solution unlimited = test::Solve(settings, scene);
    EXPECT_GT(unlimited.report.elapsed, nanoseconds(0));
    for (const Budget& plenty :
         {Budget::Work(1'000'000'000'000), Budget::Time(std::chrono::hours(24))}) {
      const Solution s = test::Solve(Within(settings, plenty), scene);
      EXPECT_TRUE(test::SameBits(unlimited, s));
      EXPECT_EQ(s.report.work, unlimited.report.work);
      EXPECT_EQ(s.report.stop, unlimited.report.stop);
      EXPECT_GT(s.report.elapsed, nanoseconds(0));
    }
  }
}

// Of plain sweeps only: both budgets stop between the same blocks. Where the clock stops this run
// does not matter.
TEST(Work, ReplaysPlainSweepsThatTheClockStopped) {
  const Scene scene = BigPile(6);
  for (int us : {1, 30, 100, 300, 1000}) {
    const Budget time = Budget::Time(std::chrono::microseconds(us));
    const Solution timed = test::Solve(Within(test::PlainSweeps(100000), time), scene);
    EXPECT_EQ(timed.report.stop, StopReason::kTimeSpent);
    const Budget work = Budget::Work(timed.report.work);
    EXPECT_TRUE(test::SameBits(timed, test::Solve(Within(test::PlainSweeps(100000), work), scene)));
  }
}

/// A million rows in one island: 250 000 bodies in a row, four joint rows between neighbours.
Scene MillionRows() {
  Scene scene;
  scene.bodies.assign(250'000, test::PointMass(1, {0, 0, -1}));
  scene.rows.reserve(1'000'000);
  for (int i = 0; i < 250'000; ++i) {
    for (double side : {-1, 0, 1, 2}) {
      scene.rows.push_back(test::LinearRow(i, i - 1, {side, 1, 1}));  // kWorld is -1
    }
  }
  return scene;
}

TEST(Budget, OfTimeSaysWhatStepsTookAndWereToTake) {
  const Scene scene = BigPile(3);
  const Budget day = Budget::Time(std::chrono::hours(24));
  const test::ScriptedClock clock = test::TickingClock(std::chrono::microseconds(1));
  Settings timed = Within(test::AlwaysSteps(20), day);
  timed.tuning.clock = &clock;
  const Report report = test::Solve(timed, scene).report;
  EXPECT_GT(report.factorisations, 0);
  EXPECT_GT(report.step_predicted, nanoseconds(0));
  EXPECT_GT(report.step_time, nanoseconds(0));
  EXPECT_LT(report.step_time, clock.looks() * std::chrono::microseconds(1));

  for (const Settings& without : {Within(test::PlainSweeps(20), day), test::AlwaysSteps(20)}) {
    const Report none = test::Solve(without, scene).report;
    EXPECT_EQ(none.step_predicted, nanoseconds(0));
    EXPECT_EQ(none.step_time, nanoseconds(0));
  }
}

TEST(Budget, OfTimeTriesAStepThatMayFitToLearnWhatItTakes) {
  using std::chrono::microseconds;
  // 81 us by the price that is begun with and the margin, 31 on a fast machine, 130 on a slow one
  constexpr double kUnits = 5e4;
  WorkPrices prices;
  const test::ScriptedClock still = test::TickingClock(nanoseconds(0));
  const auto tries = [&](double units, Budget budget) {
    WorkPrices copy = prices;
    BudgetMeter meter(budget, 0, &copy, &still);
    return meter.Fits(units, 0);
  };
  EXPECT_TRUE(tries(kUnits, Budget::Time(microseconds(80))));
  EXPECT_FALSE(tries(kUnits, Budget::Work(100)));
  // too much even there, or where it is slow twice the budget, or 0.1 ms too much
  EXPECT_FALSE(tries(kUnits, Budget::Time(microseconds(30))));
  EXPECT_FALSE(tries(kUnits, Budget::Time(microseconds(60))));
  EXPECT_FALSE(tries(100 * kUnits, Budget::Time(microseconds(8000))));
  // the last two may be tried where steps are given up when the time is
  prices.can_give_up_steps = true;
  EXPECT_FALSE(tries(kUnits, Budget::Time(microseconds(30))));
  EXPECT_TRUE(tries(kUnits, Budget::Time(microseconds(60))));
  EXPECT_TRUE(tries(100 * kUnits, Budget::Time(microseconds(8000))));
  prices.can_give_up_steps = false;

  // not again before so many frames had no room
  prices.frames_to_refuse = 1;
  EXPECT_FALSE(tries(kUnits, Budget::Time(microseconds(80))));
  BudgetMeter meter(Budget::Time(microseconds(80)), 0, &prices, &still);
  EXPECT_FALSE(meter.Fits(kUnits, 0));
  meter.ChargeFinish();
  EXPECT_EQ(prices.frames_refused, 1);
  EXPECT_TRUE(tries(kUnits, Budget::Time(microseconds(80))));

  // a step that was timed gives the price
  const test::ScriptedClock clock = test::TickingClock(microseconds(1));
  BudgetMeter timed(Budget::Time(std::chrono::hours(1)), 0, &prices, &clock);
  EXPECT_TRUE(timed.Fits(kUnits, 0));
  timed.Begin();
  timed.Charge(WorkKind::kStep, 1e9);
  timed.ChargeFinish();
  EXPECT_TRUE(prices.step_known);
  EXPECT_LT(prices.step_ns, 1);
  EXPECT_EQ(prices.frames_refused, 0);
}

// Copying in and out is not part of the budget, and takes a second here. 60 s is for sanitizers on
// a busy machine: a whole solve takes hours.
TEST(Budget, EndsAProblemOfAMillionRows) {
  Scene scene = MillionRows();
  const Report work =
      test::Solve(Within({.tuning = {.min_sweeps = 0}}, Budget::Work(1000)), scene).report;
  EXPECT_TRUE(work.ok());
  EXPECT_EQ(work.stop, StopReason::kWorkSpent);
  EXPECT_LT(work.work, 1000 + kUnit);
  const Budget millisecond = Budget::Time(std::chrono::milliseconds(1));
  EXPECT_EQ(test::Solve(Within({.tuning = {.min_sweeps = 0}}, millisecond), scene).report.stop,
            StopReason::kTimeSpent);

  scene.rows.back().parent = 999'999;
  const Report refused = test::Solve(Settings{}, scene).report;
  EXPECT_EQ(refused.status, Status::kBadParent);
  EXPECT_EQ(refused.bad_row, 999'999);
}

}  // namespace
}  // namespace cairn
