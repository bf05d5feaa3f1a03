// SPDX-License-Identifier: MIT
// Sweeps and steps together: where steps win, and that a step never costs more than its time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cairn/detail/eigen.h"
#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using test::AlwaysSteps;
using test::PlainSweeps;
using test::Scene;
using test::Solution;

// 50 links of 1 kg with 100 kg at the end: sweeps move the weight up one link at a time.
TEST(Steps, SolveAChainWithOneFactorisationWhereSweepsDoNot) {
  const Scene chain = test::HangingChain(50, 100);
  Settings settings = AlwaysSteps(10);
  settings.k_sm = 1;
  settings.tuning.refinements = 2;
  settings.proximal_joints = 1e-8;  // no joint of a chain says what another one says
  const Solution stepped = test::Solve(settings, chain);
  EXPECT_EQ(stepped.report.factorisations, 1);
  EXPECT_EQ(stepped.report.steps_accepted, 1);
  EXPECT_EQ(stepped.report.sweeps, 10);
  EXPECT_LT(stepped.report.residual_max, 1e-9);
  EXPECT_GT(test::Solve(PlainSweeps(2000), chain).report.residual_max, 1e-3);

  // By hand: the first joint carries everything, and nothing moves.
  EXPECT_NEAR(stepped.x[2], 149 * test::kGravityStep, 1e-6);
  for (const Velocity& v : stepped.v) EXPECT_LT(View(v.linear).norm(), 1e-6);
}

// By hand: the ground carries 20 boxes. How much of that is missing after 30 sweeps, 3 of them
// steps where asked, is how fast the tower sags.
TEST(Steps, CarryATowerThatSweepsLetSag) {
  const Scene tower = test::Tower(20);
  const auto missing = [](const Solution& s) {
    double carried = 0;
    for (int point = 0; point < 4; ++point) carried += s.x[3 * point];
    return std::abs(20 * test::kGravityStep - carried);
  };
  const Solution stepped = test::Solve(AlwaysSteps(30), tower);
  const Solution plain = test::Solve(PlainSweeps(30), tower);
  EXPECT_GT(stepped.report.steps_accepted, 0);
  EXPECT_LT(stepped.report.residual_max, 0.1 * plain.report.residual_max);
  EXPECT_LT(missing(stepped), 0.2 * missing(plain));
}

/// 8 bodies, 60 contact rows in all directions: a step predicts badly here.
Scene Irregular(std::uint64_t seed) {
  return test::RandomPile({.bodies = 8, .contacts = 20, .world_share = 0.1}, seed);
}

/// The sweeps of AlwaysSteps() alone, which end as those do.
Settings NoSteps(int sweeps) {
  Settings settings = AlwaysSteps(sweeps);
  settings.k_sm = 0;
  return settings;
}

// Every step of these was undone: what is left is plain sweeps, as many as were made.
TEST(Steps, ThatAreUndoneLeaveTheBitsOfPlainSweeps) {
  int undone = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Scene scene = Irregular(seed);
    for (int sweeps : {10, 20, 40}) {
      const Solution s = test::Solve(AlwaysSteps(sweeps), scene);
      if (s.report.steps_accepted > 0) continue;
      ASSERT_GT(s.report.steps_restored, 0);
      undone += s.report.steps_restored;
      const Solution plain = test::Solve(NoSteps(sweeps), scene);
      EXPECT_TRUE(test::SameBits(s, plain)) << "seed " << seed << ", " << sweeps << " sweeps";
      EXPECT_EQ(s.report.sweeps, plain.report.sweeps);
      EXPECT_EQ(s.report.residual_energy, plain.report.residual_energy);
    }
  }
  EXPECT_GE(undone, 20) << "search for harder scenes";
}

// 5 sweeps, a step, 5 sweeps. The step was compared with 5 sweeps alone, so the end is no worse
// than 10 plain sweeps: its residual is no larger, or it is closer in energy and at most four times
// as rough. There is one exception, by design: a step that brought the
// residual to a tenth (kSureGain, island_cycle.cc) is kept without the comparison. In longer runs
// nothing is promised: each comparison starts where the last one ended. Under a budget friction has
// no sweep of its own in the end, which was not compared.
TEST(Steps, NeverEndOneCycleWorseThanPlainSweeps) {
  int compared = 0, better = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    for (const Scene& scene :
         {Irregular(seed), test::RandomPile({.bodies = 6, .contacts = 6, .pins = 4}, seed)}) {
      const double before = test::Solve(PlainSweeps(5), scene).report.residual_energy;
      const auto solve = [&scene](Settings settings) {
        settings.budget = Budget::Work(1'000'000'000);
        return test::Solve(settings, scene).report;
      };
      const Report swept = solve(NoSteps(10)), stepped = solve(AlwaysSteps(10));
      const double plain = swept.residual_energy;
      if (stepped.islands.size() != 1) continue;
      if (stepped.residual_energy <= 0.1 * before) continue;  // sure gain: see above
      const bool closer = stepped.islands[0].merit < swept.islands[0].merit;
      EXPECT_LE(stepped.residual_energy, (closer ? 4 : 1) * plain) << seed;
      ++compared;
      if (closer) ++better;
    }
  }
  EXPECT_GT(compared, 100);
  EXPECT_GT(better, 20);
}

// By the rule of the cycle: steps come after every second round of k_gs sweeps.
TEST(Steps, ComeAfterEverySecondRoundAndNeedThreeSweepsAfterThem) {
  const Scene tower = test::Tower(3);
  for (const auto& [sweeps, steps] :
       {std::pair(0, 0), {5, 0}, {7, 0}, {8, 1}, {10, 1}, {17, 1}, {18, 2}, {25, 2}, {30, 3}}) {
    const Report report = test::Solve(AlwaysSteps(sweeps), tower).report;
    EXPECT_EQ(report.steps_accepted + report.steps_restored, steps) << sweeps << " sweeps";
    EXPECT_EQ(report.sweeps, sweeps);
  }
}

TEST(Steps, AreNotTakenUnlessAskedFor) {
  const Scene tower = test::Tower(5);
  const Solution plain = test::Solve(PlainSweeps(30), tower);
  EXPECT_EQ(test::Solve(NoSteps(30), tower).report.factorisations, 0);
  Settings pgs = AlwaysSteps(30), psor = AlwaysSteps(30);
  pgs.method = Method::kPgs;
  psor.method = Method::kPsor;
  for (const Settings& settings : {pgs, psor}) {
    const Solution s = test::Solve(settings, tower);
    EXPECT_EQ(s.report.factorisations, 0);
    EXPECT_TRUE(test::SameBits(s, plain));
  }
}

// In blocks and row by row. A budget of ten sweeps holds no step, which costs more than that.
TEST(Steps, AreAccountedForWithTheReasonWhyThereWereNoMore) {
  const Scene tower = test::Tower(6);
  for (const Path path : {Path::kFast, Path::kReference}) {
    const auto island = [&](Settings settings) {
      settings.path = path;
      return test::Solve(settings, tower).report.islands.at(0);
    };
    const IslandReport one = island(AlwaysSteps(10)), two = island(AlwaysSteps(20));
    EXPECT_GT(one.step_work, static_cast<std::int64_t>(tower.rows.size()));
    EXPECT_GT(two.step_work, one.step_work);
    EXPECT_EQ(two.no_step, NoStep::kEnded);

    EXPECT_EQ(island(PlainSweeps(10)).no_step, NoStep::kNotAsked);
    EXPECT_EQ(island(PlainSweeps(10)).step_work, 0);
    Settings tight = AlwaysSteps(1000);
    tight.budget = Budget::Work(10 * static_cast<std::int64_t>(tower.rows.size()));
    EXPECT_EQ(island(tight).no_step, NoStep::kTooDear);
    EXPECT_EQ(island(tight).step_work, 0);
  }
}

// Islands that share the lanes of a step share out its price.
TEST(Steps, AreChargedToIslandsByTheirRows) {
  const auto work = [](const std::vector<int>& heights) {
    Scene scene;
    for (int height : heights) {
      const Scene tower = test::Tower(height);
      const int first = static_cast<int>(scene.bodies.size());
      const int first_row = static_cast<int>(scene.rows.size());
      scene.bodies.insert(scene.bodies.end(), tower.bodies.begin(), tower.bodies.end());
      for (Row row : tower.rows) {
        if (row.body_a != kWorld) row.body_a += first;
        if (row.body_b != kWorld) row.body_b += first;
        if (row.parent != kNoRow) row.parent += first_row;
        scene.rows.push_back(row);
      }
    }
    Settings settings = AlwaysSteps(10);
    settings.path = Path::kFast;
    std::vector<std::int64_t> of_islands;
    for (const IslandReport& island : test::Solve(settings, scene).report.islands) {
      of_islands.push_back(island.step_work);
    }
    return of_islands;
  };
  const auto both = work({3, 6});
  ASSERT_EQ(both.size(), 2u);
  EXPECT_NEAR(static_cast<double>(both[1]), 2 * static_cast<double>(both[0]), 2);
}

// Whatever the steps do, k_sm limits the factorisations of each.
TEST(Steps, MakeNoMoreFactorisationsThanAllowed) {
  int most = 0;
  for (int k_sm : {1, 2, 4}) {
    Settings settings = AlwaysSteps(10);
    settings.k_sm = k_sm;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      const Report report = test::Solve(settings, Irregular(seed)).report;
      if (report.islands.size() != 1) continue;
      EXPECT_LE(report.factorisations, k_sm);
      EXPECT_GE(report.factorisations, 1);
      most = std::max(most, report.factorisations);
    }
  }
  EXPECT_EQ(most, 4);
}

}  // namespace
}  // namespace cairn
