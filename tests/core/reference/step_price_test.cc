// SPDX-License-Identifier: MIT
// Where steps are tried: what a failed one, a price and a budget do to the next, by hand.
#include "reference/step_price.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/support/packed.h"
#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using test::Packed;

/// Asks a memory again and again.
class Asked {
 public:
  explicit Asked(const test::Scene& scene, Budget budget = Budget::Unlimited())
      : packed_(scene, 0), meter_(budget, 0, &prices_) {}

  bool Pays(StepPolicy policy = StepPolicy::kMeasured, double sweeps = 0) {
    settings_.step_policy = policy;
    return memory_.Due(settings_) &&
           StepPays(packed_.island, settings_, {&meter_, sweeps}, &memory_);
  }
  /// Opportunities passed over until the next step.
  int Pause() {
    int pause = 0;
    while (!Pays() && pause < 1000) ++pause;
    return pause;
  }
  double Softened() { return memory_.Step(settings_).proximal / settings_.tuning.proximal; }
  double Cost() { return StepCost(packed_.island, settings_, settings_.k_sm, SystemOf(&memory_)); }
  IslandMemory& memory() { return memory_; }

 private:
  Packed packed_;
  Settings settings_;
  WorkPrices prices_;
  BudgetMeter meter_;
  IslandMemory memory_;
};

TEST(IslandMemory, PausesTwiceAsLongAfterEachFailureInARow) {
  Asked asked(test::Tower(3));
  EXPECT_EQ(asked.Pause(), 0);
  for (int pause : {1, 2, 4, 8, 16, 32, 32}) {
    asked.memory().Restored();
    EXPECT_EQ(asked.Pause(), pause);
    EXPECT_EQ(asked.Pause(), 0);
  }
  asked.memory().Accepted();
  asked.memory().Restored();
  EXPECT_EQ(asked.Pause(), 1);
}

TEST(IslandMemory, DoesNotPauseWhereStepsAreAlwaysTaken) {
  Asked asked(test::Tower(3));
  asked.memory().Restored();
  EXPECT_TRUE(asked.Pays(StepPolicy::kAlways));
}

// 5 times softer after a failure, at most 100 times; half as soft after a success, and below what
// is set only as far as failures are forgotten.
TEST(IslandMemory, SoftensStepsThatFailAndHardensThemAgain) {
  Asked asked(test::Tower(3));
  EXPECT_DOUBLE_EQ(asked.Softened(), 1);
  for (double softening : {5, 25, 100, 100}) {
    asked.memory().Restored();
    EXPECT_DOUBLE_EQ(asked.Softened(), softening);
  }
  for (double softening : {50.0, 25.0, 12.5, 6.25, 3.125, 1.5625}) {
    asked.memory().Accepted();
    EXPECT_DOUBLE_EQ(asked.Softened(), softening);
  }
  asked.memory().Accepted();
  EXPECT_DOUBLE_EQ(asked.Softened(), std::pow(0.98, 7));
  for (int i = 0; i < 100; ++i) asked.memory().Accepted();
  EXPECT_DOUBLE_EQ(asked.Softened(), IslandMemory::kLeastSoftening);
}

// Half the term after each success, down to what is allowed; after a failure not below five times
// the one that failed, which 35 successes forget by half.
TEST(IslandMemory, LowersTheProximalTermWhereThatIsAllowedUntilItFails) {
  Asked asked(test::Tower(3));
  constexpr double kLeast = 1.0 / 32;
  for (double softening : {1 / 2.0, 1 / 4.0, 1 / 8.0}) {
    asked.memory().Accepted(kLeast);
    EXPECT_DOUBLE_EQ(asked.Softened(), softening);
  }
  asked.memory().Restored();
  EXPECT_DOUBLE_EQ(asked.Softened(), 5 / 8.0);
  for (int i = 0; i < 34; ++i) asked.memory().Accepted(kLeast);
  EXPECT_NEAR(asked.Softened(), 5 / 16.0, 0.01);
  for (int i = 0; i < 1000; ++i) asked.memory().Accepted(kLeast);
  EXPECT_DOUBLE_EQ(asked.Softened(), kLeast);
}

// 60 bodies that all touch one another with one row a pair: a dense factor of 360 costs 1.5e7
// multiply-adds, some 270 sweeps over 1770 rows. In a chain it is next to nothing.
TEST(IslandMemory, LeavesOutStepsThatCostMoreThanTheyCanGain) {
  test::Scene clique, chain;
  clique.bodies.assign(60, test::Box(1, {1, 1, 1}));
  for (int i = 0; i < 60; ++i) {
    for (int j = i + 1; j < 60; ++j) clique.rows.push_back(test::LinearRow(i, j, {1, 0, 0}));
  }
  Asked dear(clique), cheap(test::HangingChain(60, 1));
  EXPECT_FALSE(dear.Pays());
  EXPECT_TRUE(dear.Pays(StepPolicy::kAlways));
  EXPECT_GT(dear.Cost(), 150 * 1770);
  EXPECT_TRUE(cheap.Pays());
  EXPECT_LT(cheap.Cost(), 150 * 180);
}

// To the last unit; what did not fit is not asked for again for a while.
TEST(IslandMemory, StartsAStepOnlyIfItFitsTheBudgetWithItsSweeps) {
  const test::Scene tower = test::Tower(3);
  Asked unlimited(tower);
  EXPECT_TRUE(unlimited.Pays());
  const int cost = static_cast<int>(unlimited.Cost()) + 1;
  EXPECT_TRUE(Asked(tower, Budget::Work(cost + 100)).Pays(StepPolicy::kMeasured, 100));
  Asked tight(tower, Budget::Work(cost + 98));
  EXPECT_FALSE(tight.Pays(StepPolicy::kMeasured, 100));
  EXPECT_FALSE(tight.Pays());
  EXPECT_EQ(tight.Pause(), 29);
  EXPECT_FALSE(Asked(tower, Budget::Work(cost - 2)).Pays(StepPolicy::kAlways));
}

}  // namespace
}  // namespace cairn
