// SPDX-License-Identifier: MIT
// What a solver remembers of an island from frame to frame, and under which name.
#include <gtest/gtest.h>

#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using test::Scene;
using test::Solution;

Settings Remembering() {
  Settings settings = test::AlwaysSteps(60);
  settings.step_policy = StepPolicy::kMeasured;
  return settings;
}

Scene Pile(std::uint64_t seed) {
  return test::RandomPile({.bodies = 8, .contacts = 20, .world_share = 0.1}, seed);
}

/// A pile on which steps fail: a solver pauses and softens them there, so that its next frame is
/// another. The first of 100 seeds; some 40 of them would do.
Scene HardPile(std::uint64_t first_id) {
  Scene scene;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    scene = Pile(seed);
    Solver solver(Remembering());
    const Solution first = test::Solve(&solver, scene);
    if (first.report.steps_restored == 0) continue;
    if (!test::SameBits(first, test::Solve(&solver, scene))) break;
  }
  for (Body& body : scene.bodies) body.id = first_id == 0 ? 0 : first_id++;
  return scene;
}

TEST(Memory, OfAnIslandChangesItsNextFrame) {
  Solver solver(Remembering());
  const Solution first = test::Solve(&solver, HardPile(1));
  EXPECT_GT(first.report.steps_restored, 0);
  const Solution second = test::Solve(&solver, HardPile(1));
  EXPECT_FALSE(test::SameBits(first, second));
  const Solution stranger = test::Solve(&solver, HardPile(1000));
  EXPECT_TRUE(test::SameBits(first, stranger)) << "another name is another island";
}

// The pile moves from the front of the problem to the back: only its name stays.
TEST(Memory, FollowsTheNameOfTheBodiesNotTheirPlace) {
  Solver by_name(Remembering()), by_place(Remembering());
  for (const auto& [solver, id] : {std::pair(&by_name, 50), {&by_place, 0}}) {
    Scene scene = HardPile(id);
    const Solution first = test::Solve(solver, scene);
    scene.bodies.insert(scene.bodies.begin(), 3, test::PointMass(1));
    for (Row& row : scene.rows) {
      if (row.body_a != kWorld) row.body_a += 3;
      if (row.body_b != kWorld) row.body_b += 3;
    }
    const Solution second = test::Solve(solver, scene);
    EXPECT_EQ(first.x == second.x, solver == &by_place);
  }
}

TEST(Memory, IsGoneAfterReset) {
  Solver solver(Remembering());
  const Solution first = test::Solve(&solver, HardPile(1));
  for (int frame = 0; frame < 5; ++frame) (void)test::Solve(&solver, HardPile(1));
  solver.Reset();
  EXPECT_EQ(solver.settings().max_sweeps, 60);
  EXPECT_TRUE(test::SameBits(first, test::Solve(&solver, HardPile(1))));
}

// 120 frames are kForgetAfter in solver.cc: two seconds of game.
TEST(Memory, LastsTwoSecondsWithoutTheIsland) {
  const Scene other = test::Tower(1);
  for (const auto& [frames, forgotten] : {std::pair(100, false), {125, true}}) {
    Solver solver(Remembering());
    const Solution first = test::Solve(&solver, HardPile(77));
    for (int frame = 0; frame < frames; ++frame) (void)test::Solve(&solver, other);
    EXPECT_EQ(test::SameBits(first, test::Solve(&solver, HardPile(77))), forgotten) << frames;
  }
}

TEST(Memory, MovesWithTheSolver) {
  Solver a(Remembering()), b(Remembering());
  (void)test::Solve(&a, HardPile(1));
  (void)test::Solve(&b, HardPile(1));
  Solver moved(std::move(a));
  EXPECT_TRUE(test::SameBits(test::Solve(&moved, HardPile(1)), test::Solve(&b, HardPile(1))));
}

/// Two towers of different heights; the names of the lower and the upper one start as told, 0 for
/// none.
Scene TwoTowers(std::uint64_t lower, std::uint64_t higher) {
  Scene scene = test::Tower(3);
  const Scene second = test::Tower(7);
  for (Row row : second.rows) {
    row.body_a += 3;
    if (row.body_b != kWorld) row.body_b += 3;
    if (row.parent != kNoRow) row.parent += 36;
    scene.rows.push_back(row);
  }
  scene.bodies.insert(scene.bodies.end(), second.bodies.begin(), second.bodies.end());
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    scene.bodies[i].id = i < 3 ? lower : higher;
  }
  return scene;
}

// A body without a name goes by its place: body 0 by the 1 that somebody else may be called. Two
// bodies of one name are a mistake of the caller, but no reason to mix up their systems.
TEST(Memory, IsNotSharedByIslandsWhoseNamesCollide) {
  const Solution expected = test::Solve(test::AlwaysSteps(40), TwoTowers(100, 200));
  EXPECT_GT(expected.report.steps_accepted, 1);
  for (const auto& [lower, higher] : {std::pair(0, 1), {4, 0}, {5, 5}, {0, 0}}) {
    Solver solver(test::AlwaysSteps(40));
    const Solution s = test::Solve(&solver, TwoTowers(lower, higher));
    EXPECT_TRUE(test::SameBits(s, expected)) << lower << " and " << higher;
  }
}

}  // namespace
}  // namespace cairn
