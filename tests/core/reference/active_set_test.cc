// SPDX-License-Identifier: MIT
// One body with rows along its six axes: d = 1, and x - w / d is the target. All by hand.
#include "reference/active_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cairn {
namespace {

using testing::ElementsAre;

constexpr RowSide kFree = RowSide::kFree, kLo = RowSide::kLo, kHi = RowSide::kHi;

/// Up to six rows, each with its present impulse.
struct SixAxes {
  PackedIsland island{.rows = {}, .bodies = 1};
  IslandState state{.x = {}, .u = Array<Vector6>(2, Vector6{})};

  int Add(double lo, double hi, double target, double x) {
    const size_t axis = island.rows.size();
    PackedRow row{.g_a = {},
                  .g_b = {},
                  .a = 1,
                  .b = 0,
                  .target = target,
                  .compliance = 0,
                  .diagonal = 1,
                  .step = 1,
                  .lo = lo,
                  .hi = hi,
                  .friction = 0,
                  .parent = kNoRow,
                  .max_sweeps = 100,
                  .angular = false};
    row.g_a[axis] = 1;
    island.rows.push_back(row);
    state.x.push_back(x);
    state.u[1][axis] = x;
    return static_cast<int>(axis);
  }
  int AddFriction(int parent, double friction, double target, double x) {
    const int row = Add(-kInfinity, kInfinity, target, x);
    island.rows[row].parent = parent;
    island.rows[row].friction = friction;
    return row;
  }
};

TEST(PredictActiveSet, FreesWhatEndsBetweenItsBounds) {
  SixAxes six;
  six.Add(-kInfinity, kInfinity, 100, 0);
  six.Add(0, kInfinity, 2, 0);   // at its bound now, will leave it
  six.Add(0, kInfinity, -1, 5);  // the other way round
  six.Add(-1, 1, 3, 0);
  six.Add(-1, 1, -3, 0);
  six.Add(-1, 1, 0.9, 1);
  EXPECT_THAT(PredictActiveSet(six.island, six.state),
              ElementsAre(kFree, kFree, kLo, kHi, kLo, kFree));
}

// At a bound to rounding is at the bound; so is a row whose bounds meet.
TEST(PredictActiveSet, FixesWhatEndsAtItsBound) {
  SixAxes six;
  six.Add(0, kInfinity, 0, 1);
  six.Add(0, kInfinity, 1e-12, 1);
  six.Add(0, 1, 1 - 1e-12, 1);
  six.Add(0, kInfinity, 1e-6, 1);
  six.Add(0.5, 0.5, 7, 0.5);
  EXPECT_THAT(PredictActiveSet(six.island, six.state), ElementsAre(kLo, kLo, kHi, kFree, kLo));
}

// The normal stays free with x = 2, friction may be +-1.
TEST(PredictActiveSet, FrictionSticksOrSlidesToOneSide) {
  SixAxes six;
  const int normal = six.Add(0, kInfinity, 3, 2);
  six.AddFriction(normal, 0.5, 0.9, 0);
  six.AddFriction(normal, 0.5, 1.1, 0);
  six.AddFriction(normal, 0.5, -1.1, 0);
  EXPECT_THAT(PredictActiveSet(six.island, six.state), ElementsAre(kFree, kFree, kHi, kLo));
}

// What counts is where the parent is going: off at 0, or at its upper bound of 3 where friction
// may be +-1.5 although the present 1 allows +-0.5 only.
TEST(PredictActiveSet, FrictionFollowsAParentThatGoesToItsBound) {
  SixAxes six;
  const int lifting = six.Add(0, kInfinity, -1, 2);
  six.AddFriction(lifting, 0.5, 0.1, 0.1);
  const int limited = six.Add(0, 3, 9, 1);
  six.AddFriction(limited, 0.5, 1.2, 0);
  six.AddFriction(limited, 0.5, 1.6, 0);
  const ActiveSet set = PredictActiveSet(six.island, six.state);
  EXPECT_THAT(set, ElementsAre(kLo, kLo, kHi, kFree, kHi));
}

TEST(PredictActiveSet, FrictionOfAFreeParentWithoutImpulseIsFixed) {
  SixAxes six;
  const int normal = six.Add(0, kInfinity, 1, 0);
  six.AddFriction(normal, 0.5, 5, 0);
  EXPECT_THAT(PredictActiveSet(six.island, six.state), ElementsAre(kFree, kLo));
}

TEST(PredictActiveSet, ADeadRowIsNeverFree) {
  SixAxes six;
  six.Add(-kInfinity, kInfinity, 1, 0);
  six.island.rows[0].g_a.fill(0);
  six.island.rows[0].diagonal = 0;
  EXPECT_THAT(PredictActiveSet(six.island, six.state), ElementsAre(kLo));
}

TEST(RemoveViolated, FixesFreeRowsAtTheBoundTheyCrossed) {
  SixAxes six;
  six.Add(0, kInfinity, 0, -0.1);
  six.Add(-1, 1, 0, 1.1);
  six.Add(-1, 1, 0, 0.9);
  six.Add(-1, 1, 0, 5);
  ActiveSet set{kFree, kFree, kFree, kLo};
  EXPECT_EQ(RemoveViolated(six.island, six.state, &set), 2);
  EXPECT_THAT(set, ElementsAre(kLo, kHi, kFree, kLo));
  EXPECT_EQ(RemoveViolated(six.island, six.state, &set), 0);
}

// Friction slides where it exceeds its share of the new normal impulse, and a normal that was just
// removed takes its friction with it, in the same pass.
TEST(RemoveViolated, MakesFrictionSlideAndFollowsARemovedParent) {
  SixAxes six;
  const int pressing = six.Add(0, kInfinity, 0, 2);
  six.AddFriction(pressing, 0.5, 0, -1.01);
  six.AddFriction(pressing, 0.5, 0, 0.99);
  const int pulling = six.Add(0, kInfinity, 0, -2);
  six.AddFriction(pulling, 0.5, 0, 0.3);
  ActiveSet set(5, kFree);
  EXPECT_EQ(RemoveViolated(six.island, six.state, &set), 3);
  EXPECT_THAT(set, ElementsAre(kFree, kLo, kFree, kLo, kHi));
  EXPECT_EQ(FixedImpulse(set[4], BoundsOf(six.island.rows[4], six.state.x)), 0);
}

}  // namespace
}  // namespace cairn
