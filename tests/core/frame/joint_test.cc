// SPDX-License-Identifier: MIT
// What is particular to joints that are no rows; that they are their rows: manifold_test.cc.
#include "cairn/joint.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "cairn/detail/eigen.h"
#include "pack/block_frame.h"
#include "tests/core/support/block_problems.h"
#include "tests/core/support/manifold_problems.h"

namespace cairn {
namespace {

using test::ManifoldScene;

/// A box of 1 kg that hangs from the world in its centre, and another one that hangs from it.
ManifoldScene Hanging() {
  ManifoldScene scene;
  for (int i = 0; i < 2; ++i) {
    scene.bodies.push_back(test::Box(1, {1, 1, 1}));
    scene.bodies.back().impulse = {0, -test::kGravityStep, 0};
    scene.joints.push_back({.body_a = i, .body_b = i - 1, .first_row = 3 * i, .rows = 3});
    for (int k = 0; k < 3; ++k) {
      JointRow& row = scene.joint_rows.emplace_back();
      row.linear_a[k] = 1;
      row.linear_b[k] = -1;
    }
  }
  scene.joint_impulses.resize(scene.joint_rows.size());
  return scene;
}

Report Solve(const Settings& settings, ManifoldScene* scene, std::vector<Velocity>* velocities) {
  velocities->resize(scene->bodies.size());
  return Solver(settings).Solve(scene->problem(), scene->impulses(), *velocities);
}

TEST(Joint, CarriesWhatHangsFromIt) {
  // by hand: the upper one carries both boxes, the lower one its own
  for (const bool opposite : {false, true}) {
    for (const Path path : {Path::kFast, Path::kReference}) {
      ManifoldScene scene = Hanging();
      for (Joint& joint : scene.joints) joint.opposite = opposite;
      Settings settings;
      settings.path = path;
      settings.max_sweeps = 200;
      settings.tolerance = 2e-5;
      std::vector<Velocity> velocities;
      ASSERT_TRUE(Solve(settings, &scene, &velocities).ok());
      EXPECT_NEAR(scene.joint_impulses[1], 2 * test::kGravityStep, 1e-3);
      EXPECT_NEAR(scene.joint_impulses[4], test::kGravityStep, 1e-3);
      for (const Velocity& velocity : velocities) EXPECT_LE(View(velocity.linear).norm(), 1e-3);
    }
  }
}

// A wide register has lanes beyond those of a block, which must not look there either.
TEST(Joint, DoesNotLookAtWhatIsOppositeOnAnyTarget) {
  for (const simd::Target target : simd::SupportedTargets()) {
    const test::AskFor asked(target);
    ManifoldScene scene = Hanging();
    for (Joint& joint : scene.joints) joint.opposite = true;
    for (JointRow& row : scene.joint_rows) {
      for (float& number : row.linear_b) number = std::numeric_limits<float>::quiet_NaN();
    }
    std::vector<Velocity> velocities;
    const Report report = Solve(Settings{}, &scene, &velocities);
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.path, Path::kFast) << simd::TargetName(target);
  }
}

TEST(Joint, GivesNoMoreThanItsBounds) {
  for (const Path path : {Path::kFast, Path::kReference}) {
    ManifoldScene scene = Hanging();
    scene.joints[1].bounded = 1u << 1;
    scene.joint_rows[4].lo = 0;
    scene.joint_rows[4].hi = 0.125f;
    Settings settings;
    settings.path = path;
    std::vector<Velocity> velocities;
    ASSERT_TRUE(Solve(settings, &scene, &velocities).ok());
    EXPECT_FLOAT_EQ(scene.joint_impulses[4], 0.125f);
    EXPECT_NEAR(velocities[1].linear.y(), 0.125 - test::kGravityStep, 1e-6);
  }
}

TEST(Joint, WorksAgainstItsShareOfWhatBodiesDo) {
  for (const Path path : {Path::kFast, Path::kReference}) {
    ManifoldScene scene = Hanging();
    scene.joints.resize(1);
    scene.joints[0].damping = 0.25f;
    Settings settings;
    settings.path = path;
    std::vector<Velocity> velocities;
    ASSERT_TRUE(Solve(settings, &scene, &velocities).ok());
    EXPECT_NEAR(velocities[0].linear.y(), -0.75 * test::kGravityStep, 1e-6);
  }
}

TEST(Joint, KeepsItsPlanWhileItsNumbersChange) {
  ManifoldScene scene = Hanging();
  BlockFrame frame;
  Crew crew(1);
  const auto begin = [&] { return frame.Begin(scene.problem(), 1, scene.impulses(), &crew); };
  ASSERT_EQ(begin(), PackResult::kDone);
  scene.joint_rows[2].target = 0.5f;
  scene.joints[1].damping = 0.5f;
  ASSERT_EQ(begin(), PackResult::kDone);
  EXPECT_EQ(frame.plan_number(), 1);
  scene.joints[1].bounded = 1;
  scene.joint_rows[3].hi = 1;
  ASSERT_EQ(begin(), PackResult::kDone);
  EXPECT_EQ(frame.plan_number(), 2);
}

TEST(Joint, WithOppositeForcesHasOneDirectionForBoth) {
  ManifoldScene scene = Hanging();
  BlockFrame frame;
  Crew crew(1);
  ASSERT_EQ(frame.Begin(scene.problem(), 1, scene.impulses(), &crew), PackResult::kDone);
  EXPECT_EQ(frame.plan().pair(0, 0).form, simd::PairForm::kJoint);
  scene.joints[1].opposite = true;
  ASSERT_EQ(frame.Begin(scene.problem(), 1, scene.impulses(), &crew), PackResult::kDone);
  EXPECT_EQ(frame.plan().pair(0, 0).form, simd::PairForm::kContact);
}

struct Bad {
  const char* name;
  Status status;
  void (*spoil)(ManifoldScene*);
};

TEST(Joint, ThatIsRefusedIsNamedByItsField) {
  const auto said = [](void (*spoil)(Joint*)) {
    ManifoldScene scene = test::RandomManifolds(10, 20, 2);
    test::AddJoints(20, 2, &scene);
    spoil(&scene.joints[7]);
    std::vector<Velocity> velocities(scene.bodies.size());
    return Describe(Solve(Settings{}, &scene, &velocities));
  };
  EXPECT_EQ(said([](Joint* j) { j->rows = 33; }), "joint 7: rows is 33, must be 1 to 32");
  EXPECT_EQ(said([](Joint* j) { j->first_row = -3; }),
            "joint 7: first_row is -3, must be 0 to problem.joint_rows.size() - rows");
}

TEST(Joint, HasAnErrorForEachRowOrNone) {
  ManifoldScene scene = Hanging();
  scene.joint_errors.assign(5, 0);
  std::vector<Velocity> velocities;
  EXPECT_EQ(Describe(Solve(Settings{}, &scene, &velocities)),
            "problem.joint_errors.size() is 5, must be 0 or problem.joint_rows.size()");
}

// Both hang, and the upper one is to rise: of that half takes back an error.
TEST(Joint, TellsWhatOfItsTargetTakesBackAnError) {
  ManifoldScene scene = Hanging();
  scene.joint_rows[1].target = 1;
  Settings settings;
  settings.max_sweeps = 200;
  settings.tolerance = 2e-5;
  std::vector<Velocity> velocities;
  EXPECT_EQ(Solve(settings, &scene, &velocities).gap.asked, 0);
  scene.joint_errors.assign(scene.joint_rows.size(), 0);
  scene.joint_errors[1] = 0.5f;
  const Report report = Solve(settings, &scene, &velocities);
  EXPECT_EQ(report.gap.asked, 0.5);
  EXPECT_NEAR(report.gap.done, 0.5, 1e-3);

  // and without the velocity of it, it still rises by what is left
  settings.relax = true;
  scene.joint_impulses.assign(scene.joint_rows.size(), 0);
  ASSERT_TRUE(Solve(settings, &scene, &velocities).ok());
  EXPECT_NEAR(velocities[0].linear.y(), 0.5, 1e-3);
  EXPECT_NEAR(velocities[1].linear.y(), 0.5, 1e-3);
}

class BadJoint : public testing::TestWithParam<Bad> {};

TEST_P(BadJoint, IsRefusedAndNothingIsWritten) {
  for (const Path path : {Path::kFast, Path::kReference}) {
    ManifoldScene scene = test::RandomManifolds(10, 20, 2);
    test::AddJoints(20, 2, &scene);
    scene.joints[5].bounded |= 1;
    scene.joints[5].soft = true;
    GetParam().spoil(&scene);
    const std::vector<float> before = scene.joint_impulses;
    Settings settings;
    settings.path = path;
    std::vector<Velocity> velocities(scene.bodies.size());
    velocities[0].linear.x() = 7;
    const Report report = Solve(settings, &scene, &velocities);
    EXPECT_EQ(report.status, GetParam().status);
    EXPECT_NE(report.bad_setting.name, nullptr);
    EXPECT_EQ(report.bad_joint, before.size() == scene.joint_rows.size() ? 5 : -1);
    const std::span<const float> now = scene.joint_impulses;
    EXPECT_EQ(std::memcmp(now.data(), before.data(), before.size() * sizeof(float)), 0);
    EXPECT_EQ(velocities[0].linear.x(), 7);
  }
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
JointRow& RowOf(ManifoldScene* scene) { return scene->joint_rows[scene->joints[5].first_row]; }
const Bad kBad[] = {
    {"NoRows", Status::kWrongSize, [](ManifoldScene* s) { s->joints[5].rows = 0; }},
    {"TooManyRows", Status::kWrongSize, [](ManifoldScene* s) { s->joints[5].rows = 33; }},
    {"NegativeFirst", Status::kWrongSize, [](ManifoldScene* s) { s->joints[5].first_row = -1; }},
    {"RowsBeyondTheEnd", Status::kWrongSize,
     [](ManifoldScene* s) { s->joints[5].first_row = 2147483647; }},
    {"TooFewStarts", Status::kWrongSize, [](ManifoldScene* s) { s->joint_impulses.pop_back(); }},
    {"SameBodyTwice", Status::kNoSuchBody,
     [](ManifoldScene* s) { s->joints[5].body_a = s->joints[5].body_b = 3; }},
    {"WorldTwice", Status::kNoSuchBody,
     [](ManifoldScene* s) { s->joints[5].body_a = s->joints[5].body_b = kWorld; }},
    {"UnknownBody", Status::kNoSuchBody, [](ManifoldScene* s) { s->joints[5].body_a = 10; }},
    {"NanDamping", Status::kNotFinite, [](ManifoldScene* s) { s->joints[5].damping = kNan; }},
    {"NanLinear", Status::kNotFinite, [](ManifoldScene* s) { RowOf(s).linear_a[1] = kNan; }},
    {"NanAngular", Status::kNotFinite, [](ManifoldScene* s) { RowOf(s).angular_b[2] = kNan; }},
    {"NanTarget", Status::kNotFinite, [](ManifoldScene* s) { RowOf(s).target = kNan; }},
    {"NanError", Status::kNotFinite,
     [](ManifoldScene* s) {
       s->joint_errors.assign(s->joint_rows.size(), 0);
       s->joint_errors[s->joints[5].first_row] = kNan;
     }},
    {"NanLo", Status::kNotFinite, [](ManifoldScene* s) { RowOf(s).lo = kNan; }},
    {"NanHi", Status::kNotFinite, [](ManifoldScene* s) { RowOf(s).hi = kNan; }},
    {"NanCompliance", Status::kNotFinite, [](ManifoldScene* s) { RowOf(s).compliance = kNan; }},
    {"NanStart", Status::kNotFinite,
     [](ManifoldScene* s) { s->joint_impulses[s->joints[5].first_row] = kNan; }},
    {"NegativeCompliance", Status::kBadCompliance,
     [](ManifoldScene* s) { RowOf(s).compliance = -1; }},
    {"BoundsInTheWrongOrder", Status::kBadBounds,
     [](ManifoldScene* s) {
       RowOf(s).lo = 1;
       RowOf(s).hi = 0.5f;
     }},
    {"EndlessLowerBound", Status::kBadBounds,
     [](ManifoldScene* s) { RowOf(s).lo = RowOf(s).hi = std::numeric_limits<float>::infinity(); }},
};
INSTANTIATE_TEST_SUITE_P(Inputs, BadJoint, testing::ValuesIn(kBad),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace cairn
