// SPDX-License-Identifier: MIT
// What a report says for sleeping: how fast the bodies of an island are, and for how long not.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "cairn/solver.h"

namespace cairn {
namespace {

/// Bodies that glide; pairs of them are held together by a joint that asks for nothing.
struct Gliders {
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<JointRow> rows;
  Solver solver;
  Report report;

  int Add(const Velocity& velocity, std::uint64_t id) {
    bodies.push_back(
        {.inv_mass = 1, .inv_inertia = Matrix3::Diagonal(1, 1, 1), .velocity = velocity, .id = id});
    return static_cast<int>(bodies.size()) - 1;
  }
  /// Across all that moves here: along y.
  void Join(int a, int b) {
    joints.push_back({.body_a = a, .body_b = b, .first_row = static_cast<int>(rows.size())});
    rows.push_back({.linear_a = {0, 1, 0}, .linear_b = {0, -1, 0}});
  }
  void Solve() {
    std::vector<float> impulses(rows.size(), 0);
    std::vector<Velocity> velocities(bodies.size());
    const ContactProblem problem{.bodies = bodies, .joints = joints, .joint_rows = rows};
    solver.Solve(problem, {.joint_rows = impulses}, velocities, &report);
    ASSERT_TRUE(report.ok()) << Describe(report);
  }
  const IslandReport& island(int body) const { return report.islands[report.island_of[body]]; }
};

Velocity Linear(double x, double z) { return {.linear = {x, 0, z}}; }
Velocity Spin(double y) { return {.angular = {0, y, 0}}; }

TEST(Sleep, IslandsKnowTheirFastestBody) {
  for (const Path path : {Path::kFast, Path::kReference}) {
    Gliders world;
    world.solver.settings().path = path;
    for (const Velocity& velocity : {Linear(0.3, 0.4), Spin(2), Linear(0, 0.25), Spin(-0.5)}) {
      world.Add(velocity, world.bodies.size() + 1);
    }
    world.Join(0, 1);
    world.Join(2, 3);
    world.Solve();
    EXPECT_NEAR(world.island(0).speed, 0.5, 1e-6);
    EXPECT_NEAR(world.island(0).spin, 2, 1e-6);
    EXPECT_NEAR(world.island(2).speed, 0.25, 1e-6);
    EXPECT_NEAR(world.island(2).spin, 0.5, 1e-6);
  }
}

TEST(Sleep, BodiesKnowTheirIsland) {
  for (const Path path : {Path::kFast, Path::kReference}) {
    for (const int substeps : {1, 2}) {
      Gliders world;
      world.solver.settings().path = path;
      world.solver.settings().substeps = substeps;
      for (std::uint64_t id = 1; id <= 5; ++id) world.Add({}, id);
      world.Join(3, 0);
      world.Join(1, kWorld);
      world.Solve();
      const Array<int>& of = world.report.island_of;
      ASSERT_EQ(of.size(), 5u);
      ASSERT_EQ(world.report.islands.size(), 2u);
      EXPECT_EQ(of[2], -1);
      EXPECT_EQ(of[4], -1);
      EXPECT_EQ(of[3], of[0]);
      EXPECT_NE(of[1], of[0]);
      EXPECT_EQ(world.island(0).bodies, 2);
      EXPECT_EQ(world.island(1).bodies, 1);
      EXPECT_EQ(world.island(1).first_body, 1);
    }
  }
}

TEST(Sleep, SpeedIsThatAfterTheStep) {
  Gliders world;
  world.Add({}, 1);
  world.bodies[0].impulse = {3, 0, 0};
  world.Join(0, kWorld);
  world.Solve();
  EXPECT_NEAR(world.island(0).speed, 3, 1e-6);
}

// Where velocities are counted from the start of the step, by hand: 1 + 0.5 m/s, and 2 rad/s.
TEST(Sleep, SpeedIsThatOfBodiesWhoseMotionIsToldApart) {
  Gliders world;
  world.Add(Linear(0.5, 0), 1);
  world.Join(0, kWorld);
  ContactMotion motion;
  motion.free_velocity[0] = motion.start_velocity[0] = 1;
  motion.free_spin[1] = motion.start_spin[1] = 2;
  float impulse = 0;
  Velocity velocity;
  const ContactProblem problem{.bodies = world.bodies,
                               .motions = {&motion, 1},
                               .joints = world.joints,
                               .joint_rows = world.rows};
  const Report report = world.solver.Solve(problem, {.joint_rows = {&impulse, 1}}, {&velocity, 1});
  ASSERT_TRUE(report.ok());
  EXPECT_NEAR(report.islands[0].speed, 1.5, 1e-6);
  EXPECT_NEAR(report.islands[0].spin, 2, 1e-6);
}

TEST(Sleep, CountsSolvesThatLeftAllBodiesOfAnIslandQuiet) {
  Gliders world;
  world.Add(Linear(0.01, 0), 1);
  world.Add(Spin(0.01), 2);
  world.Join(0, 1);
  for (int n = 1; n <= 5; ++n) {
    world.Solve();
    EXPECT_EQ(world.island(0).quiet, n);
  }
  world.bodies[1].velocity = Spin(0.06);  // above 0.05
  world.Solve();
  EXPECT_EQ(world.island(0).quiet, 0);
  world.bodies[1].velocity = {};
  world.Solve();
  EXPECT_EQ(world.island(0).quiet, 1);
}

TEST(Sleep, BodiesWithNamesMayBeAnywhere) {
  Gliders world;
  for (std::uint64_t id = 1; id <= 4; ++id) {
    world.Join(world.Add({}, id), kWorld);
  }
  for (int n = 1; n <= 6; ++n) {
    world.Solve();
    for (int body = 0; body < 4; ++body) EXPECT_EQ(world.island(body).quiet, n);
    std::rotate(world.bodies.begin(), world.bodies.begin() + 1, world.bodies.end());
  }
  // one is removed as engines do, and one is new
  world.bodies[1] = world.bodies.back();
  world.bodies.back().id = 9;
  world.Solve();
  for (int body = 0; body < 3; ++body) EXPECT_EQ(world.island(body).quiet, 7);
  EXPECT_EQ(world.island(3).quiet, 1);
}

TEST(Sleep, ABodyOfAnotherMassIsAnotherBodyWhereNoneHasAName) {
  Gliders world;
  world.Add({}, 0);
  world.Join(0, kWorld);
  for (int n = 0; n < 3; ++n) world.Solve();
  EXPECT_EQ(world.island(0).quiet, 3);
  world.bodies[0].inv_mass = 2;
  world.Solve();
  EXPECT_EQ(world.island(0).quiet, 1);
}

TEST(Sleep, WhatIsJoinedIsAsQuietAsTheLatestOfItsBodies) {
  Gliders world;
  world.Add({}, 1);
  world.Add({}, 2);
  world.Add(Linear(1, 0), 3);
  for (int body = 0; body < 3; ++body) world.Join(body, kWorld);
  for (int n = 0; n < 3; ++n) world.Solve();
  EXPECT_EQ(world.island(0).quiet, 3);
  EXPECT_EQ(world.island(2).quiet, 0);
  world.bodies[2].velocity = {};
  world.Join(0, 2);
  world.Solve();
  EXPECT_EQ(world.island(0).quiet, 1);
  EXPECT_EQ(world.island(1).quiet, 4);
}

TEST(Sleep, WhatIsUnknownIsNotQuiet) {
  Gliders world;
  world.Add({}, 1);
  world.Join(0, kWorld);
  world.Solve();
  world.Solve();
  EXPECT_EQ(world.island(0).quiet, 2);
  world.bodies[0].id = 7;  // another body
  world.Solve();
  EXPECT_EQ(world.island(0).quiet, 1);
  world.Solve();
  world.solver.Reset();
  world.Solve();
  EXPECT_EQ(world.island(0).quiet, 1);
  // a frame without rows: in the air
  world.joints.clear();
  world.Solve();
  EXPECT_EQ(world.report.island_of[0], -1);
  world.Join(0, kWorld);
  world.Solve();
  EXPECT_EQ(world.island(0).quiet, 1);
}

TEST(Sleep, HowSlowIsQuietIsASetting) {
  Gliders world;
  world.Add(Linear(0.1, 0), 1);
  world.Join(0, kWorld);
  world.solver.settings().tuning.quiet_speed = 0.2;
  world.Solve();
  EXPECT_EQ(world.island(0).quiet, 1);
  world.solver.settings().tuning.quiet_speed = 0;
  world.Solve();
  EXPECT_EQ(world.island(0).quiet, 0);
  Settings bad;
  bad.tuning.quiet_speed = -1;
  EXPECT_EQ(Describe(FindBadSetting(bad)), "tuning.quiet_speed is -1, must be 0 or more");
}

}  // namespace
}  // namespace cairn
