// SPDX-License-Identifier: MIT
// What ValidateStrictly() finds, and that it finds nothing in good problems.
#include "cairn/strict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "cairn/detail/eigen.h"
#include "tests/core/support/manifold_problems.h"

namespace cairn {
namespace {

using test::ManifoldScene;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A tower of three boxes, the upper two of which a joint of three rows holds together.
ManifoldScene Good() {
  ManifoldScene scene = test::ManifoldTower(3);
  for (size_t i = 0; i < scene.bodies.size(); ++i) scene.bodies[i].id = i + 1;
  scene.joints.push_back({.body_a = 2, .body_b = 1, .rows = 3});
  scene.joint_rows.resize(3);
  scene.joint_impulses.resize(3);
  for (int k = 0; k < 3; ++k) {
    scene.joint_rows[k].linear_a[k] = 1;
    scene.joint_rows[k].linear_b[k] = -1;
  }
  return scene;
}

std::vector<std::string> FindingsOf(ManifoldScene scene, int most = 20) {
  std::vector<std::string> texts;
  for (const Finding& finding : ValidateStrictly(scene.problem(), scene.impulses(), most)) {
    texts.push_back(Describe(finding));
  }
  return texts;
}

/// What is found after one change of a good problem.
std::vector<std::string> After(const std::function<void(ManifoldScene*)>& change) {
  ManifoldScene scene = Good();
  change(&scene);
  return FindingsOf(scene);
}

void Set(float* to, float x, float y, float z) { to[0] = x, to[1] = y, to[2] = z; }

TEST(ValidateStrictly, FindsNothingInGoodProblems) {
  EXPECT_THAT(FindingsOf(Good()), IsEmpty());
  ManifoldScene joints = Good();
  joints.joints[0].opposite = true;
  EXPECT_THAT(FindingsOf(joints), IsEmpty());
}

TEST(ValidateStrictly, NamesDirectionsOfPoints) {
  EXPECT_THAT(After([](auto* s) { Set(s->points[3].normal, 0, 2, 0); }),
              ElementsAre("points[3].normal is (0, 2, 0), must be a unit vector"));
  EXPECT_THAT(After([](auto* s) { Set(s->points[3].normal, 0, 0, 0); }),
              ElementsAre("points[3].normal is (0, 0, 0), must be a unit vector"));
  EXPECT_THAT(After([](auto* s) { Set(s->points[3].tangent, 3, 0, 0); }),
              ElementsAre("points[3].tangent is (3, 0, 0), must be a unit vector, or zeros"));
  EXPECT_THAT(After([](auto* s) {
                Set(s->points[3].normal, 0, 1, 0);
                Set(s->points[3].tangent, 0, 1, 0);
              }),
              ElementsAre("points[3].tangent is (0, 1, 0), must be at right angles to normal "
                          "(0, 1, 0)"));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(After([=](auto* s) { Set(s->points[1].normal, nan, 1, 0); }),
              ElementsAre("points[1].normal is (nan, 1, 0), must be a unit vector"));
}

TEST(ValidateStrictly, NamesNumbersOfPoints) {
  EXPECT_THAT(After([](auto* s) { s->points[2].bias = std::numeric_limits<float>::infinity(); }),
              ElementsAre("points[2].bias is inf, must be finite"));
  EXPECT_THAT(After([](auto* s) { s->points[2].friction = -0.5f; }),
              ElementsAre("points[2].friction is -0.5, must be 0 or more"));
  EXPECT_THAT(After([](auto* s) { s->points[2].compliance = 1; }),
              ElementsAre("points[2].compliance is 1, must be 0: Manifold::soft is off"));
  EXPECT_THAT(After([](auto* s) { s->law.bounce_speed = -1; }),
              ElementsAre("contact_law.bounce_speed is -1, must be 0 or more"));
  EXPECT_THAT(After([](auto* s) { s->point_impulses[1].normal = std::nanf(""); }),
              ElementsAre("impulses.points[1].normal is nan, must be finite"));
}

TEST(ValidateStrictly, NamesManifolds) {
  EXPECT_THAT(After([](auto* s) { s->manifolds[1].points = 5; }),
              ElementsAre("manifolds[1].points is 5, must be 1 to 4"));
  EXPECT_THAT(After([](auto* s) { s->manifolds[1].body_a = 9; }),
              ElementsAre("manifolds[1].body_a is 9, must be kWorld, or 0 to 2"));
  EXPECT_THAT(After([](auto* s) { s->manifolds[1].body_b = s->manifolds[1].body_a; }),
              ElementsAre(HasSubstr("must be another body than body_a")));
  EXPECT_THAT(After([](auto* s) { s->manifolds[1].first_point = 0; }),
              ElementsAre("manifolds[1].first_point is 0, must be behind what others have"));
  EXPECT_THAT(After([](auto* s) { s->manifolds[2].first_point = 9; }),
              ElementsAre("manifolds[2].first_point is 9, must be 0 to 8"));
  EXPECT_THAT(
      After([](auto* s) { s->bodies[0].inv_mass = 0, View(s->bodies[0].inv_inertia).setZero(); }),
      ElementsAre(HasSubstr("must be a body that moves, or body_b")));
}

TEST(ValidateStrictly, NamesRowsOfJoints) {
  EXPECT_THAT(After([](auto* s) { s->joint_rows[1] = {}; }),
              ElementsAre("joint_rows[1].linear_a is (0, 0, 0), must be a direction: the row does "
                          "nothing"));
  EXPECT_THAT(After([](auto* s) {
                s->joints[0].opposite = true;
                Set(s->joint_rows[0].linear_b, 1, 0, 0);
              }),
              ElementsAre("joint_rows[0].linear_b is (1, 0, 0), must be -linear_a, as "
                          "Joint::opposite says"));
  EXPECT_THAT(After([](auto* s) { s->joints[0].angular = 4; }),
              ElementsAre(HasSubstr("joint_rows[2].linear_a is (0, 0, 1), must be zeros")));
  EXPECT_THAT(After([](auto* s) {
                s->joint_rows[2] = {};
                Set(s->joint_rows[2].angular_a, 1, 0, 0);
              }),
              ElementsAre(HasSubstr("joint_rows[2].angular_a is (1, 0, 0), must be marked")));
  EXPECT_THAT(After([](auto* s) { s->joint_rows[0].lo = -1; }),
              ElementsAre(HasSubstr("joint_rows[0].lo is -1, must be -infinity")));
  EXPECT_THAT(After([](auto* s) {
                s->joints[0].bounded = 1;
                s->joint_rows[0].lo = 2, s->joint_rows[0].hi = 1;
              }),
              ElementsAre(HasSubstr("joint_rows[0].lo is 2, must be at most hi")));
  EXPECT_THAT(After([](auto* s) { s->joint_rows[0].compliance = 1; }),
              ElementsAre("joint_rows[0].compliance is 1, must be 0: Joint::soft is off"));
  EXPECT_THAT(After([](auto* s) { s->joints[0].rows = 40; }),
              ElementsAre("joints[0].rows is 40, must be 1 to 32"));
}

TEST(ValidateStrictly, NamesBodies) {
  EXPECT_THAT(After([](auto* s) { s->bodies[2].id = 1; }),
              ElementsAre("bodies[2].id is 1, must be another than that of bodies[0]"));
  EXPECT_THAT(After([](auto* s) { s->bodies[1].inv_mass = -1; }),
              ElementsAre("bodies[1].inv_mass is -1, must be 0 or more"));
  EXPECT_THAT(After([](auto* s) { s->bodies[1].impulse.y() = std::nan(""); }),
              ElementsAre("bodies[1].impulse is (0, nan, 0), must be finite"));
  EXPECT_THAT(After([](auto* s) { s->bodies[1].inv_inertia(0, 1) = 100; }),
              ElementsAre(HasSubstr("must be symmetric positive semidefinite")));
}

TEST(ValidateStrictly, NamesRows) {
  EXPECT_THAT(After([](auto* s) {
                s->rows.push_back({.body_a = 0});
                s->row_impulses.push_back(0);
              }),
              ElementsAre(HasSubstr("rows[0].linear_a is (0, 0, 0), must be a direction")));
  EXPECT_THAT(After([](auto* s) {
                s->rows.push_back({.body_a = 0, .linear_a = {1, 0, 0}, .lo = 1, .hi = 0});
                s->row_impulses.push_back(0);
              }),
              ElementsAre(HasSubstr("rows[0] is refused")));
}

TEST(ValidateStrictly, NamesSizes) {
  EXPECT_THAT(After([](auto* s) { s->point_impulses.pop_back(); }),
              ElementsAre("impulses.points.size() is 11, must be problem.points.size()"));
  EXPECT_THAT(After([](auto* s) { s->bodies.clear(); }),
              ElementsAre("bodies.size() is 0, must be 1 or more"));
}

TEST(ValidateStrictly, StopsAfterSoMany) {
  ManifoldScene scene = Good();
  for (ContactPoint& point : scene.points) Set(point.normal, 0, 0, 0);
  EXPECT_EQ(FindingsOf(scene, 5).size(), 5u);
  EXPECT_EQ(FindingsOf(scene, 50).size(), scene.points.size());
}

/// Whatever Solve() refuses is found, too.
TEST(ValidateStrictly, FindsWhatSolveRefuses) {
  int refused = 0;
  const auto expect = [&refused](const std::function<void(ManifoldScene*)>& change) {
    ManifoldScene scene = Good();
    change(&scene);
    std::vector<Velocity> velocities(scene.bodies.size());
    const Report report = Solver().Solve(scene.problem(), scene.impulses(), velocities);
    refused += report.ok() ? 0 : 1;
    EXPECT_THAT(FindingsOf(scene), testing::Not(IsEmpty())) << Describe(report);
  };
  expect([](auto* s) { s->bodies[0].velocity.linear.x() = kInfinity; });
  expect([](auto* s) { s->points[0].restitution = -1; });
  expect([](auto* s) { s->manifolds[0].tangents = 3; });
  expect([](auto* s) { s->manifolds[0].twists = true; });
  expect([](auto* s) { s->joints[0].damping = std::nanf(""); });
  expect([](auto* s) { s->joint_rows[0].target = std::nanf(""); });
  expect([](auto* s) { s->joint_impulses[0] = std::nanf(""); });
  EXPECT_EQ(refused, 7);
}

}  // namespace
}  // namespace cairn
