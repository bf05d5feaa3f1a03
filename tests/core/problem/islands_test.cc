// SPDX-License-Identifier: MIT
#include "problem/islands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cairn/detail/eigen.h"
#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using test::Scene;
using test::Solution;
using testing::ElementsAre;
using testing::IsEmpty;

// Bodies 0-3-5 by rows 1 and 4, 1-2 by row 3, 4 alone on the world by row 2; 6 has no rows, and 7,
// that cannot move, touches 3 and 4 and joins nobody. Row 0 moves nothing.
TEST(FindIslands, JoinsBodiesThatShareRowsInTheOrderOfTheProblem) {
  Scene scene;
  scene.bodies.assign(7, test::PointMass(1));
  scene.bodies.push_back(Body{});
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const auto join = [&](int a, int b) { scene.rows.push_back(test::LinearRow(a, b, x)); };
  join(kWorld, 7);
  join(5, 3);
  join(kWorld, 4);
  join(2, 1);
  join(3, 0);
  join(7, 3);
  join(4, 7);

  const Array<Island> islands = FindIslands(scene.problem());
  ASSERT_EQ(islands.size(), 4u);
  EXPECT_THAT(islands[0].bodies, ElementsAre(0, 3, 5));
  EXPECT_THAT(islands[0].rows, ElementsAre(1, 4, 5));
  EXPECT_THAT(islands[1].bodies, ElementsAre(1, 2));
  EXPECT_THAT(islands[1].rows, ElementsAre(3));
  EXPECT_THAT(islands[2].bodies, ElementsAre(4));
  EXPECT_THAT(islands[2].rows, ElementsAre(2, 6));
  EXPECT_THAT(islands[3].bodies, IsEmpty());
  EXPECT_THAT(islands[3].rows, ElementsAre(0));
}

TEST(CanMove, NeedsAnAxisThatYields) {
  EXPECT_FALSE(CanMove(Body{}));
  EXPECT_TRUE(CanMove(test::PointMass(1)));
  Body locked = test::PointMass(1);
  View(locked.linear_factor).setZero();
  EXPECT_FALSE(CanMove(locked));
  locked.inv_inertia(1, 1) = 1;
  EXPECT_TRUE(CanMove(locked));
  Body turning;
  turning.inv_inertia(2, 2) = 1;
  EXPECT_TRUE(CanMove(turning));
}

/// Puts @p b behind @p a, without a row between them.
Scene SideBySide(const Scene& a, const Scene& b) {
  Scene both = a;
  const int bodies = static_cast<int>(a.bodies.size()), rows = static_cast<int>(a.rows.size());
  both.bodies.insert(both.bodies.end(), b.bodies.begin(), b.bodies.end());
  for (Row row : b.rows) {
    if (row.body_a != kWorld) row.body_a += bodies;
    if (row.body_b != kWorld) row.body_b += bodies;
    if (row.parent != kNoRow) row.parent += rows;
    both.rows.push_back(row);
  }
  return both;
}

Solution Joined(const Solution& a, const Solution& b) {
  Solution both = a;
  both.x.insert(both.x.end(), b.x.begin(), b.x.end());
  both.v.insert(both.v.end(), b.v.begin(), b.v.end());
  return both;
}

// Accepted steps in the towers and the chain, rejected ones in the piles: neither sees the other.
TEST(Islands, SolvedTogetherHaveTheBitsOfEachAlone) {
  const std::vector<Scene> scenes = {test::Tower(6), test::HangingChain(8, 20),
                                     test::RandomPile({.bodies = 8, .contacts = 20}, 3),
                                     test::RandomPile({.bodies = 30, .contacts = 40}, 4)};
  for (const Settings& settings : {test::PlainSweeps(40), test::AlwaysSteps(40), Settings{}}) {
    int accepted = 0;
    for (const Scene& a : scenes) {
      for (const Scene& b : scenes) {
        const Solution alone_a = test::Solve(settings, a), alone_b = test::Solve(settings, b);
        const Solution together = test::Solve(settings, SideBySide(a, b));
        EXPECT_TRUE(test::SameBits(together, Joined(alone_a, alone_b)));
        EXPECT_EQ(together.report.steps_accepted,
                  alone_a.report.steps_accepted + alone_b.report.steps_accepted);
        EXPECT_EQ(together.report.islands.size(),
                  alone_a.report.islands.size() + alone_b.report.islands.size());
        accepted += together.report.steps_accepted;
      }
    }
    EXPECT_EQ(accepted > 0, settings.method == Method::kPgsSm);
  }
}

// A static body under two towers: one tower's weight must not reach the other through it.
TEST(Islands, AreNotConnectedByABodyThatCannotMove) {
  Scene scene;
  scene.bodies = {Body{}, test::PointMass(1, {0, 0, -1}), test::PointMass(1, {0, 0, -5})};
  scene.rows = {test::PushRow(1, 0, {0, 0, 1}), test::PushRow(2, 0, {0, 0, 1})};
  const Solution s = test::Solve(Settings{}, scene);
  ASSERT_EQ(s.report.islands.size(), 2u);
  EXPECT_EQ(s.report.islands[0].first_body, 1);
  EXPECT_EQ(s.report.islands[1].first_body, 2);
  EXPECT_EQ(s.x, (std::vector<double>{1, 5}));
}

}  // namespace
}  // namespace cairn
