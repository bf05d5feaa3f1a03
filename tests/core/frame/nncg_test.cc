// SPDX-License-Identifier: MIT
// Sweeps that build on each other, without steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using test::Scene;
using test::Solution;

Settings Sweeps(Acceleration acceleration, int sweeps) {
  Settings settings = test::Coloured(sweeps);
  settings.method = Method::kPgsSm;
  settings.k_sm = 0;
  settings.acceleration = acceleration;
  return settings;
}

int SweepsTo(double tolerance, Acceleration acceleration, const Scene& scene) {
  Settings settings = Sweeps(acceleration, 20000);
  settings.tolerance = tolerance;
  const Solution s = test::Solve(settings, scene);
  EXPECT_EQ(s.report.stop, StopReason::kConverged);
  EXPECT_LE(Measure(scene.problem(), s.x).residual_max, 1.1 * tolerance);
  return s.report.sweeps;
}

// Conjugate gradients take the root of the steps that plain descent takes where all rows are free,
// as in a chain; contacts make them start anew now and then.
TEST(Nncg, TakesFewerSweepsWhereErrorsTravelFar) {
  const auto ratio = [](const Scene& scene) {
    return SweepsTo(1e-3, Acceleration::kNone, scene) / SweepsTo(1e-3, Acceleration::kNncg, scene);
  };
  EXPECT_GE(ratio(test::HangingChain(40, 10)), 8);
  EXPECT_GE(ratio(test::Tower(20)), 2);
  EXPECT_GE(ratio(test::Wall(12, 12)), 2);
}

TEST(Nncg, LeavesMethodsThatSayWhatTheyAreAlone) {
  const Scene scene = test::Wall(6, 6);
  for (const Method method : {Method::kPgs, Method::kPsor}) {
    Settings with = Sweeps(Acceleration::kNncg, 20), without = Sweeps(Acceleration::kNone, 20);
    with.method = without.method = method;
    EXPECT_TRUE(test::SameBits(test::Solve(with, scene), test::Solve(without, scene)));
  }
  EXPECT_FALSE(test::SameBits(test::Solve(Sweeps(Acceleration::kNncg, 20), scene),
                              test::Solve(Sweeps(Acceleration::kNone, 20), scene)));
}

// What was moved out of its bounds must not be what the caller gets, wherever a budget ends.
TEST(Nncg, EndsInsideTheBoundsAfterAnyWork) {
  const Scene scene = test::WithEveryLaw(
      test::Heap({.bodies = 150, .contacts = 400, .pins = 10, .world_share = 0.3}, 5), 5);
  const int sweep = static_cast<int>(scene.rows.size());
  for (int work = 1; work < 30 * sweep; work += sweep / 3 + 1) {
    Settings settings = Sweeps(Acceleration::kNncg, 1000);
    settings.budget = Budget::Work(work);
    settings.tuning.min_sweeps = 0;
    const Solution s = test::Solve(settings, scene);
    ASSERT_TRUE(s.report.ok());
    for (size_t i = 0; i < scene.rows.size(); ++i) {
      const Row& row = scene.rows[i];
      const double rounding = 1e-6 * std::abs(s.x[i]);
      ASSERT_GE(s.x[i], row.lo - rounding) << "row " << i << ", work " << work;
      ASSERT_LE(s.x[i], row.hi + rounding) << "row " << i << ", work " << work;
      // what takes part in few sweeps does not follow its parent after those
      if (row.parent == kNoRow || row.host.max_sweeps < 1000) continue;
      const double most = row.friction * std::max(0.0, s.x[row.parent]);
      ASSERT_LE(std::abs(s.x[i]), most + rounding + 1e-12) << "row " << i << ", work " << work;
    }
  }
}

TEST(Nncg, KeepsVelocitiesConsistentWithImpulses) {
  const Scene scene = test::Wall(8, 8);
  const Solution s = test::Solve(Sweeps(Acceleration::kNncg, 200), scene);
  EXPECT_NEAR(Measure(scene.problem(), s.x).residual_max, s.report.residual_max,
              1e-5 + 1e-2 * s.report.residual_max);
}

}  // namespace
}  // namespace cairn
