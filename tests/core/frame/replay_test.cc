// SPDX-License-Identifier: MIT
// Budgets on blocks: what they cost at most, what they leave, and timed frames made again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

#include "cairn/detail/eigen.h"
#include "tests/core/support/block_problems.h"
#include "tests/core/support/test_clock.h"

namespace cairn {
namespace {

using std::chrono::microseconds;
using test::Coloured;
using test::Scene;
using test::Solution;

/// A claim of a thread (kUnitRows, plan.cc) and the rest of its last block.
constexpr int kUnit = 2048;
/// Rows between two looks at the budget at most (kStageRows, plan.cc), likewise.
constexpr int kStage = 8192 + kUnit;
/// What one look at the residual costs (BlockSweeps::kMeasureSweeps).
constexpr double kMeasureSweeps = 0.6;

Settings Within(Settings settings, Budget budget) {
  settings.budget = budget;
  return settings;
}

/// Rows between two looks at the budget.
void ExpectOvershoot(const Scene& scene, const Settings& settings, double most) {
  const int sweep = static_cast<int>(scene.rows.size());
  for (int work = 1; work < 8 * sweep; work += sweep / 9 + 1) {
    const Report report = test::Solve(Within(settings, Budget::Work(work)), scene).report;
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.stop, StopReason::kWorkSpent);
    EXPECT_GE(report.work, work);
    ASSERT_LT(static_cast<double>(report.work), work + most);
  }
}

TEST(BlockWork, ExceedsTheBudgetByLessThanAUnit) {
  ExpectOvershoot(test::Wall(18, 17), Coloured(1000), kUnit);
  ExpectOvershoot(test::Together(std::vector<Scene>(100, test::HangingChain(20, 5))),
                  Coloured(1000), kUnit);
  ExpectOvershoot(test::Tower(8), Coloured(1000), kUnit);
}

// Colours of few pairs each are taken by one thread in one go.
TEST(BlockWork, ExceedsTheBudgetByLessThanAStageWhereColoursAreTiny) {
  ExpectOvershoot(test::Heap({.bodies = 120, .contacts = 5000}, 3), Coloured(1000), kStage);
}

// A plate under a thousand boxes: 968 pairs have no colour, and are relaxed one by one.
TEST(BlockWork, ExceedsTheBudgetByLessThanAStageWhereColoursRunOut) {
  ExpectOvershoot(test::Plate(1000), Coloured(1000), kStage);
}

TEST(BlockWork, WithALookAtTheResidualExceedsTheBudgetByThatToo) {
  const Scene scene = test::Wall(18, 17);
  Settings settings = Coloured(1000);
  settings.tolerance = 1e-7;
  const double look = kMeasureSweeps * static_cast<double>(scene.rows.size());
  ExpectOvershoot(scene, settings, kUnit + look + 1);
}

TEST(BlockWork, BelowTheSweepsThatAreMadeInAnyCaseMakesThose) {
  const Scene scene = test::Wall(18, 17);
  for (const int sweeps : {1, 3}) {
    const Solution expected = test::Solve(Coloured(sweeps), scene);
    for (const Budget& nothing : {Budget::Work(0), Budget::Time(microseconds(0))}) {
      Settings settings = Within(Coloured(1000), nothing);
      settings.tuning.min_sweeps = sweeps;
      const Solution s = test::Solve(settings, scene);
      EXPECT_TRUE(test::SameBits(s, expected));
      EXPECT_EQ(s.report.sweeps, sweeps);
    }
  }
}

/// The residual that so many sweeps of work leave.
double EnergyAfter(const Scene& scene, int sweeps) {
  const auto work = sweeps * static_cast<std::int64_t>(scene.rows.size());
  const Solution s = test::Solve(Within(Coloured(1000), Budget::Work(work)), scene);
  const double energy = Measure(scene.problem(), s.x).residual_energy;
  EXPECT_NEAR(energy, s.report.residual_energy, 1e-3 * energy + 1e-5);
  return energy;
}

// Between two copies a state may be a little better than what comes later: hence the percent.
// Floats are off by 1e-7 of the impulses, which add up over the rows of a body.
TEST(BlockWork, MoreOfItDoesNotLeaveALargerResidualOfStandingPiles) {
  for (const Scene& scene : {test::Tower(20), test::Wall(10, 10), test::Wall(4, 12),
                             test::NormalsFirst(test::Wall(12, 8)), test::Plate(50)}) {
    double best = kInfinity;
    for (int sweeps = 1; sweeps <= 320; sweeps += 1 + sweeps / 5) {
      const double energy = EnergyAfter(scene, sweeps);
      EXPECT_LE(energy, 1.01 * best + 1e-5) << sweeps << " sweeps";
      best = std::min(best, energy);
    }
  }
}

// Where friction bounds move, sweeps can make it worse: then an earlier state comes back. Copies
// are taken after 5, 10, 20, 40 ... sweeps: what was there then is not lost.
TEST(BlockWork, MoreOfItDoesNotLeaveALargerResidualThanItsCopies) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Scene scene = test::Heap({.bodies = 60, .contacts = 130, .world_share = 0.3}, seed);
    double best = kInfinity;
    int copied = 5;
    for (int sweeps = 1; sweeps <= 330; sweeps += 1 + sweeps / 5) {
      for (; copied <= sweeps; copied *= 2) best = std::min(best, EnergyAfter(scene, copied));
      EXPECT_LE(EnergyAfter(scene, sweeps), 1.0001 * best + 1e-5)
          << sweeps << " sweeps, seed " << seed;
    }
  }
}

/// Both ways to make a frame again: what the clock decided, and a solver that has seen the same.
struct Rerun {
  Settings settings;
  std::vector<Solver> solvers;

  /// One solver with other threads, and one for each other instruction set.
  explicit Rerun(const Settings& timed) : settings(timed) {
    settings.budget = Budget::Unlimited();
    settings.threads = 3 - timed.threads;
    solvers.emplace_back(settings);
    for (const simd::Target target : simd::SupportedTargets()) {
      const test::AskFor asked(target);
      solvers.emplace_back(settings);
    }
  }

  void Expect(const test::Frame& frame, const Solution& timed) {
    for (Solver& solver : solvers) {
      solver.settings().tuning.replay = &timed.report.replay;
      const Solution again = test::Solve(&solver, frame.scene, frame.start);
      EXPECT_TRUE(test::SameBits(again, timed));
      EXPECT_EQ(again.report.work, timed.report.work);
      EXPECT_EQ(again.report.sweeps, timed.report.sweeps);
      EXPECT_EQ(again.report.stop, timed.report.stop);
      EXPECT_EQ(again.report.steps_accepted, timed.report.steps_accepted);
      EXPECT_EQ(again.report.factorisations, timed.report.factorisations);
    }
  }
};

/// What the clock came to in some frames.
struct Timed {
  int steps = 0, spent = 0;
};

/// Plays frames with budgets from one to ten times the least, and each of them again. The clock
/// goes on where it is looked at, now more, now less.
Timed PlayTwice(const Scene& whole, const Settings& settings, microseconds least) {
  test::Game game(whole);
  const test::ScriptedClock clock = test::UnsteadyClock(microseconds(1), 5);
  Solver solver(settings);
  solver.settings().tuning.clock = &clock;
  Rerun rerun(settings);
  Timed timed;
  for (int i = 0; i < 30 && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE("frame " + std::to_string(i));
    // the first frame decides whether steps are tried again soon: it has time for them
    solver.settings().budget = Budget::Time(least * (1 + (i + 9) % 10));
    const test::Frame frame = game.Next();
    const Solution solution = test::Solve(&solver, frame.scene, frame.start);
    rerun.Expect(frame, solution);
    game.Take(frame, solution);
    timed.steps += solution.report.factorisations;
    timed.spent += solution.report.stop == StopReason::kTimeSpent ? 1 : 0;
  }
  return timed;
}

void ExpectReplays(const Scene& whole, Settings settings) {
  const bool with_steps = settings.method == Method::kPgsSm;
  for (const int threads : {1, 2}) {
    settings.threads = threads;
    const Timed timed = PlayTwice(whole, settings, microseconds(with_steps ? 200 : 50));
    EXPECT_GT(timed.spent, 0) << "nothing that the clock decided";
    EXPECT_EQ(timed.steps > 0, with_steps);
  }
}

Scene TimedIslands() {
  std::vector<Scene> parts = {test::Wall(14, 15)};
  for (int i = 0; i < 30; ++i) parts.push_back(test::HangingChain(3 + i % 9, 1 + i));
  for (int i = 0; i < 30; ++i) parts.push_back(test::Tower(1 + i % 7));
  return test::Together(parts);
}

TEST(Replay, MakesTimedSweepsAgain) {
  ExpectReplays(test::Wall(18, 17), Coloured(100000));
  ExpectReplays(test::Wall(5, 5), Coloured(100000));
}

TEST(Replay, MakesTimedSweepsOfManyIslandsAgain) {
  Settings settings = Coloured(100000);
  settings.tolerance = 1e-3;
  ExpectReplays(TimedIslands(), settings);
}

TEST(Replay, MakesTimedStepsAgain) {
  Settings settings = test::ColouredSteps(100000);
  ExpectReplays(test::Together({test::Tower(2), test::HangingChain(4, 3)}), settings);
  settings.step_policy = StepPolicy::kMeasured;
  settings.tolerance = 1e-4;
  ExpectReplays(test::Together({test::Wall(3, 3), test::HangingChain(6, 9), test::Tower(3)}),
                settings);
}

/// An island that goes on for long, and after it so many towers without weight that their group is
/// done after one sweep.
Scene RestingGroupLast() {
  Scene resting = test::Tower(10);
  for (Body& body : resting.bodies) View(body.impulse).setZero();
  std::vector<Scene> parts = {test::Wall(8, 8)};
  parts.insert(parts.end(), 10, resting);
  return test::Together(parts);
}

// The time is up when the last stage of a sweep is done: as after so many sweeps, which count as
// complete. No clock is needed to say so.
TEST(Replay, EndsAfterTheSweepThatTheClockEndedAfter) {
  for (const Scene& scene : {test::Wall(8, 8), test::Wall(18, 17), RestingGroupLast()}) {
    for (const int sweeps : {3, 7, 12}) {
      const Solution expected = test::Solve(Coloured(sweeps), scene);
      const Replay replay{.work = expected.report.work, .fits = {}};
      Settings settings = Coloured(1000);
      settings.tuning.replay = &replay;
      const Solution s = test::Solve(settings, scene);
      EXPECT_TRUE(test::SameBits(s, expected));
      EXPECT_EQ(s.report.work, expected.report.work);
      EXPECT_EQ(s.report.sweeps, sweeps);
      EXPECT_EQ(s.report.stop, StopReason::kTimeSpent);
    }
  }
}

TEST(Replay, OfATimeThatNeverEndsNeedsNoAnswers) {
  const Scene scene = test::Wall(6, 6);
  Settings settings = Within(Coloured(30), Budget::Time(std::chrono::hours(1)));
  const Solution timed = test::Solve(settings, scene);
  EXPECT_EQ(timed.report.replay.work, Replay{}.work);
  EXPECT_THAT(timed.report.replay.fits, testing::Each(0)) << "never late";
  const Replay replay;
  settings.tuning.replay = &replay;
  const Solution again = test::Solve(settings, scene);
  EXPECT_TRUE(test::SameBits(timed, again));
  EXPECT_EQ(again.report.stop, StopReason::kSweepLimit);
}

TEST(Replay, OfNegativeWorkIsRefused) {
  for (const std::int64_t work : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::min()}) {
    const Replay replay{.work = work, .fits = {}};
    Settings settings = Coloured(10);
    settings.tuning.replay = &replay;
    const Scene scene = test::Wall(3, 3);
    const std::vector<double> start(scene.rows.size(), 0.5);
    const Solution s = test::Solve(settings, scene, start);
    EXPECT_EQ(s.report.status, Status::kBadSettings);
    EXPECT_EQ(s.x, start);
  }
}

// What is not in the list did not fit: the frame is another one, but a frame.
TEST(Replay, WithAnswersMissingTakesNoMoreSteps) {
  const Scene scene = test::Together({test::Tower(6), test::HangingChain(6, 9)});
  Settings settings = Within(test::ColouredSteps(60), Budget::Time(std::chrono::hours(1)));
  const Solution timed = test::Solve(settings, scene);
  ASSERT_GT(timed.report.replay.fits.size(), 4u);
  int last = timed.report.factorisations;
  for (size_t size = timed.report.replay.fits.size(); size-- > 0;) {
    Replay replay = timed.report.replay;
    replay.fits.resize(size);
    settings.tuning.replay = &replay;
    const Solution s = test::Solve(settings, scene);
    EXPECT_TRUE(s.report.ok());
    EXPECT_EQ(s.report.stop, StopReason::kSweepLimit);
    EXPECT_LE(s.report.factorisations, last);
    last = s.report.factorisations;
  }
  EXPECT_EQ(last, 0);
}

}  // namespace
}  // namespace cairn
