// SPDX-License-Identifier: MIT
// What the plan reads of a row.
#include "plan/row_kind.h"

#include <gtest/gtest.h>

#include <limits>

#include "cairn/detail/eigen.h"
#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using simd::RowBound;
using simd::RowShape;

TEST(ShapeOf, ReadsTheLawOfARow) {
  Row row;
  row.linear_a = {1, 0, 0};
  EXPECT_EQ(ShapeOf(row, 1), RowShape{});
  row.lo = 0;
  EXPECT_EQ(ShapeOf(row, 1), RowShape{.bound = RowBound::kPush});
  row.hi = 5;
  EXPECT_EQ(ShapeOf(row, 1), RowShape{.bound = RowBound::kOwn});
  row.lo = -kInfinity;
  EXPECT_EQ(ShapeOf(row, 1), RowShape{.bound = RowBound::kOwn});
  row.parent = 0;
  EXPECT_EQ(ShapeOf(row, 1), RowShape{.bound = RowBound::kCutFriction});
  row.hi = kInfinity;
  EXPECT_EQ(ShapeOf(row, 1), RowShape{.bound = RowBound::kFriction});
  row = Row{};
  EXPECT_EQ(ShapeOf(row, 1), RowShape{.angular = true});
  row.compliance = 1e-300;
  row.host.max_sweeps = 3;
  row.relaxation = 0.5;
  const RowShape expected{.soft = true, .relaxed = true, .angular = true, .max_sweeps = 3};
  EXPECT_EQ(ShapeOf(row, 1), expected);
}

TEST(ReadKind, TakesWhatThePlanNeeds) {
  test::Scene scene = test::Tower(2);
  RowKind law;
  ASSERT_TRUE(ReadKind(scene.problem(), 13, 0, 1, &law));
  EXPECT_EQ(law.a, 1);
  EXPECT_EQ(law.b, 0);
  EXPECT_EQ(law.parent, 12);
  EXPECT_TRUE(law.opposite);
  EXPECT_EQ(law.shape, ShapeOf(scene.rows[13], 1));
  View(scene.rows[13].linear_a) *= 2;
  ASSERT_TRUE(ReadKind(scene.problem(), 13, 0, 1, &law));
  EXPECT_FALSE(law.opposite);
}

TEST(ReadKind, RefusesNumbersThatAreNotValid) {
  const test::Scene good = test::Tower(2);
  const auto valid = [&good](auto change) {
    test::Scene scene = good;
    change(&scene.rows[13]);
    RowKind law;
    return ReadKind(scene.problem(), 13, 0, 1, &law);
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(valid([](Row*) {}));
  for (const double bad : {-1.0, kNan}) {
    EXPECT_FALSE(valid([bad](Row* row) { row->compliance = bad; }));
    EXPECT_FALSE(valid([bad](Row* row) { row->friction = bad; }));
    EXPECT_FALSE(valid([bad](Row* row) { row->relaxation = bad; }));
  }
  for (const double bad : {kInfinity, kNan}) {
    EXPECT_FALSE(valid([bad](Row* row) { row->friction = bad; }));
    EXPECT_FALSE(valid([bad](Row* row) { row->target = -bad; }));
    EXPECT_FALSE(valid([bad](Row* row) { row->linear_a.y() = bad; }));
    EXPECT_FALSE(valid([bad](Row* row) { row->angular_b.z() = bad; }));
    RowKind law;
    EXPECT_FALSE(ReadKind(good.problem(), 13, bad, 1, &law)) << "its impulse";
  }
  EXPECT_FALSE(valid([](Row* row) { row->relaxation = 2; }));
  EXPECT_FALSE(valid([](Row* row) { row->lo = kNan; }));
  EXPECT_FALSE(valid([](Row* row) { row->hi = kNan; }));
  EXPECT_FALSE(valid([](Row* row) { row->lo = 1; })) << "friction has 0 inside its bounds";
  EXPECT_FALSE(valid([](Row* row) { row->hi = -1; }));
  EXPECT_FALSE(valid([](Row* row) { row->body_a = 2; })) << "there are two bodies";
  EXPECT_FALSE(valid([](Row* row) { row->body_b = -2; }));
  EXPECT_FALSE(valid([](Row* row) { row->body_b = row->body_a; }));
}

}  // namespace
}  // namespace cairn
