// SPDX-License-Identifier: MIT
// Helpers and the interface of C allocate nothing once they have seen as much.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "cairn/cairn.h"
#include "cairn/cairn_helpers.h"
#include "cairn/detail/eigen.h"
#include "cairn/joints.h"
#include "cairn/solver.h"
#include "tests/c/c_problems.h"
#include "tests/core/support/watched_new.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

/// Frames of an engine, whose contacts are @p depth deep.
void RunFrames(const Settings& settings, double depth) {
  constexpr int kBodies = 40;
  std::vector<Body> bodies(kBodies);
  for (int i = 0; i < kBodies; ++i) {
    bodies[i].inv_mass = 1;
    View(bodies[i].inv_inertia).setIdentity();
    bodies[i].impulse = {0, -0.16, 0};
    bodies[i].id = static_cast<std::uint64_t>(i + 1);
  }
  Contacts contacts;
  Joints joints;
  Solver solver(settings);
  std::vector<Velocity> velocities(kBodies);
  Report report;
  const auto step = [&](int frame) {
    const StepInput input{.bodies = bodies};
    contacts.Begin(input);
    joints.Begin(input);
    // the order changes from frame to frame, the number does not
    for (int k = 0; k < kBodies; ++k) {
      const int i = (k + frame) % kBodies;
      const std::array points{TouchPoint{.depth = depth, .feature = 1},
                              TouchPoint{.position = {1, 0, 0}, .depth = depth}};
      contacts.Add({.body_a = i,
                    .body_b = i % 8 == 0 ? kWorld : i - 1,  // towers of eight
                    .centre_a = {0, 0.5, 0},
                    .centre_b = {0, -0.5, 0},
                    .id = bodies[i].id},
                   points);
      if (k % 2 == 0) joints.Add(HingeJoint({.max_motor_force = 1}), {.body = i}, {}, bodies[i].id);
    }
    solver.Solve(ProblemOf(input, contacts, joints), StartOf(&contacts, &joints), velocities,
                 &report);
    ASSERT_TRUE(report.ok());
    if (settings.step_policy == StepPolicy::kAlways) {
      ASSERT_GT(report.steps_accepted, 0);
    }
  };
  for (int frame = 0; frame < 2 * kBodies; ++frame) step(frame);
  const long before = test::NewCalls();
  for (int frame = 0; frame < 1000; ++frame) step(frame);
  EXPECT_EQ(test::NewCalls() - before, 0);
}

TEST(EngineNoAlloc, HelpersAndSweepsUseMemoryAgain) { RunFrames({.steps = false}, 0); }

TEST(EngineNoAlloc, RelaxationDoesSo) { RunFrames({.steps = false, .relax = true}, 0.1); }

TEST(EngineNoAlloc, StepsDoSoWhileTheGraphIsTheSame) {
  RunFrames({.max_sweeps = 20, .tolerance = 0, .step_policy = StepPolicy::kAlways}, 0.1);
}

TEST(EngineNoAlloc, TheInterfaceOfCDoesSo) {
  test::ManifoldScene scene = test::ManifoldTower(20);
  test::CScene c = test::ToC(&scene);
  CairnSettings settings = cairnDefaultSettings();
  settings.steps = false;
  CairnSolver* solver = nullptr;
  const long at_first = test::NewCalls();
  ASSERT_EQ(cairnCreateSolver(cairnLayout(), &settings, &solver), cairnOk);
  CairnReport report;
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(cairnSolve(solver, &c.problem, &c.solution, &report), cairnOk);
  }
  const long before = test::NewCalls();
  EXPECT_GT(before, at_first);  // calls inside the library are seen
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(cairnSolve(solver, &c.problem, &c.solution, &report), cairnOk);
  }
  EXPECT_EQ(test::NewCalls() - before, 0);
  cairnDestroySolver(solver);
}

TEST(EngineNoAlloc, HelpersOfCUseMemoryAgain) {
  constexpr int kBodies = 20;
  std::vector<CairnBody> bodies(kBodies, cairnDefaultBody());
  for (CairnBody& body : bodies) body.invMass = 1;
  const CairnFrameSettings settings = cairnDefaultFrameSettings();
  CairnFrame* frame = nullptr;
  const long at_first = test::NewCalls();
  ASSERT_EQ(cairnCreateFrame(cairnHelperLayout(), &settings, &frame), cairnOk);
  const CairnJointKind hinge = cairnHingeJoint(nullptr);
  const CairnTouchPoint point = cairnDefaultTouchPoint();
  const auto step = [&](int first) {
    CairnStep input = cairnDefaultStep();
    input.bodies = bodies.data();
    input.bodyCount = kBodies;
    ASSERT_EQ(cairnBeginFrame(frame, &input), cairnOk);
    for (int k = 0; k < kBodies; ++k) {
      const int i = (k + first) % kBodies;
      CairnTouch touch = cairnDefaultTouch();
      touch.bodyA = i;
      touch.id = static_cast<std::uint64_t>(i + 1);
      ASSERT_EQ(cairnAddTouch(frame, &touch, &point, 1), cairnOk);
      CairnJointSide a = cairnDefaultJointSide();
      a.body = i;
      const CairnJointSide b = cairnDefaultJointSide();
      ASSERT_EQ(cairnAddJoint(frame, &hinge, &a, &b, touch.id, nullptr), cairnOk);
    }
    CairnProblem problem;
    CairnSolution solution;
    ASSERT_EQ(cairnFrameProblem(frame, &problem, &solution), cairnOk);
    ASSERT_EQ(problem.jointRowCount, 5 * kBodies);
  };
  for (int i = 0; i < 3; ++i) step(i);
  const long before = test::NewCalls();
  EXPECT_GT(before, at_first);
  for (int i = 0; i < 1000; ++i) step(i);
  EXPECT_EQ(test::NewCalls() - before, 0);
  cairnDestroyFrame(frame);
}

TEST(EngineNoAlloc, LackOfMemoryIsAStatusInC) {
  test::ManifoldScene scene = test::ManifoldTower(20);
  test::CScene c = test::ToC(&scene);
  const CairnSettings settings = cairnDefaultSettings();
  int failed = 0;
  for (int calls = 0; calls < 40; ++calls) {
    CairnSolver* solver = nullptr;
    test::FailNewAfter(calls);
    const CairnStatus made = cairnCreateSolver(cairnLayout(), &settings, &solver);
    const CairnStatus solved =
        made == cairnOk ? cairnSolve(solver, &c.problem, &c.solution, nullptr) : made;
    test::FailNewAfter(-1);
    EXPECT_TRUE(solved == cairnOk || solved == cairnOutOfMemory) << cairnDescribe(solved);
    failed += solved == cairnOutOfMemory ? 1 : 0;
    EXPECT_EQ(made == cairnOk, solver != nullptr);
    if (solver == nullptr) continue;
    EXPECT_EQ(cairnSolve(solver, &c.problem, &c.solution, nullptr), cairnOk);
    cairnDestroySolver(solver);
  }
  EXPECT_GT(failed, 20);
}

}  // namespace
}  // namespace cairn
