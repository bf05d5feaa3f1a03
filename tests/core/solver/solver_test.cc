// SPDX-License-Identifier: MIT
// Problems small enough to solve by hand, with the truth next to them.
#include "cairn/solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cairn/detail/eigen.h"
#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using test::PointMass;
using test::PushRow;
using test::Scene;
using test::Solution;

/// Every method, sweeping until a sweep changes nothing that a double shows at these sizes: what is
/// left is at most 1e-13 / (1 - contraction), below 1e-12 in all tests here.
std::vector<Settings> Methods() {
  const Settings sweeps{.method = Method::kPgs, .max_sweeps = 10000, .tolerance = 1e-13};
  Settings psor = sweeps, steps = sweeps;
  psor.method = Method::kPsor;
  psor.tuning.omega = 1.1;
  steps.method = Method::kPgsSm;
  steps.step_policy = StepPolicy::kAlways;
  return {sweeps, psor, steps};
}
constexpr double kRounding = 1e-12;

template <typename Check>
void ForEveryMethod(const Scene& scene, const Check& check) {
  for (const Settings& settings : Methods()) {
    SCOPED_TRACE(static_cast<int>(settings.method));
    const Solution solution = test::Solve(settings, scene);
    ASSERT_TRUE(solution.report.ok());
    EXPECT_NE(solution.report.stop, StopReason::kSweepLimit);
    EXPECT_LE(solution.report.residual_max, 1e-13);
    check(solution);
  }
}

/// Two unit masses on the ground, gravity impulse -g each.
Scene StackOfTwo(double g) {
  Scene scene;
  scene.bodies = {PointMass(1, {0, 0, -g}), PointMass(1, {0, 0, -g})};
  scene.rows = {PushRow(0, kWorld, {0, 0, 1}), PushRow(1, 0, {0, 0, 1})};
  return scene;
}

// By hand: the ground carries both, the upper contact one, nothing moves.
TEST(Solver, CarriesAStackOfTwoUnitMasses) {
  ForEveryMethod(StackOfTwo(test::kGravityStep), [](const Solution& s) {
    EXPECT_NEAR(s.x[0], 2 * test::kGravityStep, kRounding);
    EXPECT_NEAR(s.x[1], test::kGravityStep, kRounding);
    EXPECT_LT(View(s.v[0].linear).norm(), kRounding);
    EXPECT_LT(View(s.v[1].linear).norm(), kRounding);
  });
}

/// A unit mass on a plane at @p angle: normal row, then friction downhill and across.
Scene Incline(double angle, double friction) {
  Scene scene;
  scene.bodies = {PointMass(1, {0, 0, -test::kGravityStep})};
  const Vector3d normal(std::sin(angle), 0, std::cos(angle));
  const Vector3d downhill(std::cos(angle), 0, -std::sin(angle));
  scene.rows = {PushRow(0, kWorld, normal)};
  for (const Vector3d& direction : {downhill, Vector3d(0, 1, 0)}) {
    scene.rows.push_back(test::LinearRow(0, kWorld, direction));
    scene.rows.back().parent = 0;
    scene.rows.back().friction = friction;
  }
  return scene;
}

// By hand: the plane pushes with g cos a. Friction holds while g sin a <= mu g cos a.
TEST(Solver, ABoxOnAnInclineSticksJustAboveTheCoulombLimit) {
  const double angle = 0.4, g = test::kGravityStep;
  ForEveryMethod(Incline(angle, std::tan(angle) + 1e-6), [&](const Solution& s) {
    EXPECT_NEAR(s.x[0], g * std::cos(angle), kRounding);
    EXPECT_NEAR(s.x[1], -g * std::sin(angle), kRounding);
    EXPECT_NEAR(s.x[2], 0, kRounding);
    EXPECT_LT(View(s.v[0].linear).norm(), kRounding);
  });
}

// Beyond the limit friction is -mu g cos a, and what it does not hold accelerates the box downhill.
TEST(Solver, ABoxOnAnInclineSlidesBeyondTheCoulombLimit) {
  const double angle = 0.4, g = test::kGravityStep;
  for (double friction : {0.0, 0.2, std::tan(angle) - 1e-6}) {
    ForEveryMethod(Incline(angle, friction), [&](const Solution& s) {
      const double speed = g * std::sin(angle) - friction * g * std::cos(angle);
      EXPECT_NEAR(s.x[0], g * std::cos(angle), kRounding);
      EXPECT_NEAR(s.x[1], -friction * g * std::cos(angle), kRounding);
      EXPECT_NEAR(s.v[0].linear.x(), speed * std::cos(angle), kRounding);
      EXPECT_NEAR(s.v[0].linear.z(), -speed * std::sin(angle), kRounding);
    });
  }
}

// Masses 1 and 3 at 4 m/s and 0 become one: 4 / (1 + 3) = 1 m/s; the joint takes 3 N s off a.
TEST(Solver, AJointMakesTwoBodiesShareTheirMomentum) {
  Scene scene;
  scene.bodies = {PointMass(1), PointMass(3)};
  scene.bodies[0].velocity.linear = {4, 0, 0};
  scene.rows = {test::LinearRow(0, 1, {1, 0, 0})};
  ForEveryMethod(scene, [](const Solution& s) {
    EXPECT_NEAR(s.x[0], -3, kRounding);
    EXPECT_NEAR(s.v[0].linear.x(), 1, kRounding);
    EXPECT_NEAR(s.v[1].linear.x(), 1, kRounding);
  });
}

// A motor of at most 2 N s one way and 1 N s the other, on a unit mass: v = x.
TEST(Solver, AMotorGivesNoMoreThanItsLimits) {
  for (const auto& [target, expected] :
       {std::pair(10.0, 2.0), {-10.0, -1.0}, {1.5, 1.5}, {-0.5, -0.5}, {2.0, 2.0}}) {
    Scene scene;
    scene.bodies = {PointMass(1)};
    scene.rows = {test::LinearRow(0, kWorld, {0, 1, 0})};
    scene.rows[0].target = target;
    scene.rows[0].lo = -1;
    scene.rows[0].hi = 2;
    ForEveryMethod(scene, [&, expected = expected](const Solution& s) {
      EXPECT_NEAR(s.x[0], expected, kRounding);
      EXPECT_NEAR(s.v[0].linear.y(), expected, kRounding);
    });
  }
}

// 0 = w = v + E x with v = -1 + x and E = 3: x = 1/4, and the mass sinks with 3/4.
TEST(Solver, ASoftContactSinksByItsCompliance) {
  Scene scene;
  scene.bodies = {PointMass(1)};
  scene.bodies[0].velocity.linear = {0, 0, -1};
  scene.rows = {PushRow(0, kWorld, {0, 0, 1})};
  scene.rows[0].compliance = 3;
  ForEveryMethod(scene, [](const Solution& s) {
    EXPECT_NEAR(s.x[0], 0.25, kRounding);
    EXPECT_NEAR(s.v[0].linear.z(), -0.75, kRounding);
  });
}

// v + M^-1 p by hand; the inverse inertia turns an impulse about x partly into y.
TEST(Solver, BodiesWithoutRowsFollowTheirImpulses) {
  Scene scene;
  scene.bodies = {PointMass(2, {2, 4, 6}), PointMass(1)};
  scene.bodies[0].velocity = {.linear = {1, 1, 1}, .angular = {0, 0, 5}};
  View(scene.bodies[0].inv_inertia) << 2, 1, 0, 1, 2, 0, 0, 0, 4;
  scene.bodies[0].angular_impulse = {1, 0, -1};
  scene.rows = {PushRow(1, kWorld, {0, 0, 1})};  // somebody else's
  for (const auto& rows : {scene.rows, std::vector<Row>{}}) {
    scene.rows = rows;
    const Solution s = test::Solve(Settings{}, scene);
    ASSERT_TRUE(s.report.ok());
    EXPECT_EQ(s.v[0].linear, Vector3d(2, 3, 4));
    EXPECT_EQ(s.v[0].angular, Vector3d(2, 1, 1));
  }
}

TEST(Solver, AProblemWithoutRowsIsConverged) {
  Scene scene;
  scene.bodies = {PointMass(1)};
  const Report report = test::Solve(Settings{}, scene).report;
  EXPECT_EQ(report.stop, StopReason::kConverged);
  EXPECT_EQ(report.residual_max, 0);
  EXPECT_EQ(report.sweeps, 0);
  EXPECT_TRUE(report.islands.empty());
}

// A lift going up with 2 m/s takes the unit mass along: x = 2 + g. Nothing stops the lift, not even
// an impulse.
TEST(Solver, ABodyOfInfiniteMassMovesAsItWasToldTo) {
  Scene scene;
  scene.bodies = {Body{}, PointMass(1, {0, 0, -test::kGravityStep})};
  scene.bodies[0].velocity.linear = {0, 0, 2};
  scene.bodies[0].impulse = {0, 0, -1000};
  scene.rows = {PushRow(1, 0, {0, 0, 1})};
  ForEveryMethod(scene, [](const Solution& s) {
    EXPECT_NEAR(s.x[0], 2 + test::kGravityStep, kRounding);
    EXPECT_NEAR(s.v[1].linear.z(), 2, kRounding);
    EXPECT_EQ(s.v[0].linear, Vector3d(0, 0, 2));
  });
}

// Locked along z, the body keeps its speed there: not the impulse, nor the row, changes it. The row
// pushes along (0, 3, 4), only y yields: 3 v_y + 4 v_z = 0 with v = (1, -1 + 3 x, 0.5) gives
// 9 x = 3 - 2.
TEST(Solver, ALockedAxisKeepsItsSpeed) {
  Scene scene;
  scene.bodies = {PointMass(1, {1, -1, 1})};
  scene.bodies[0].linear_factor = {1, 1, 0};
  scene.bodies[0].velocity.linear = {0, 0, 0.5};
  scene.rows = {PushRow(0, kWorld, {0, 3, 4})};
  ForEveryMethod(scene, [](const Solution& s) {
    EXPECT_NEAR(s.x[0], 1.0 / 9, kRounding);
    EXPECT_NEAR((View(s.v[0].linear) - Vector3d(1, -2.0 / 3, 0.5)).norm(), 0, kRounding);
  });
}

// Half the inverse inertia about x: the hinge motor needs 3 / 2 N m s for 3 rad/s.
TEST(Solver, AHingeMotorTurnsAndIsMeasuredInRadiansPerSecond) {
  Scene scene;
  scene.bodies = {PointMass(1)};
  scene.bodies[0].inv_inertia = Vector3d(2, 1, 1).asDiagonal();
  scene.rows = {test::AngularRow(0, kWorld, {1, 0, 0})};
  scene.rows[0].target = 3;
  ForEveryMethod(scene, [](const Solution& s) {
    EXPECT_NEAR(s.x[0], 1.5, kRounding);
    EXPECT_NEAR(s.v[0].angular.x(), 3, kRounding);
    EXPECT_EQ(s.v[0].linear, Vector3d(0, 0, 0));
  });
  const Solution at_rest = test::Solve(test::PlainSweeps(0), scene);
  EXPECT_EQ(at_rest.report.residual_angular, 3);
  EXPECT_EQ(at_rest.report.residual_max, 0);
  EXPECT_NEAR(at_rest.report.residual_energy, 3 / std::sqrt(2.0), kRounding);
}

// Between bodies that cannot move only compliance answers: E x = target, within the bounds.
TEST(Solver, ARowWithoutAMovableBodyIsSolvedAlone) {
  Scene scene;
  scene.bodies = {Body{}, PointMass(1)};
  scene.rows = {test::LinearRow(0, kWorld, {1, 0, 0}), test::LinearRow(kWorld, kWorld, {1, 0, 0}),
                PushRow(0, kWorld, {1, 0, 0}), PushRow(1, 0, {0, 0, 1})};
  for (int i : {0, 1}) {
    scene.rows[i].compliance = 2;
    scene.rows[i].target = 3;
  }
  scene.rows[1].hi = 1;
  const Solution s = test::Solve(test::PlainSweeps(5), scene, {0, 0, -7, 0});
  ASSERT_TRUE(s.report.ok());
  EXPECT_EQ(s.x, (std::vector<double>{1.5, 1, 0, 0}));
  EXPECT_EQ(s.v[0].linear, Vector3d(0, 0, 0));
}

// A row that nothing can satisfy keeps its impulse, inside its bounds, and disturbs nobody.
TEST(Solver, ADeadRowDoesNothing) {
  Scene scene = StackOfTwo(test::kGravityStep);
  Row dead = PushRow(0, 1, {0, 0, 0});
  dead.target = 5;
  scene.rows.insert(scene.rows.begin() + 1, dead);
  ForEveryMethod(scene, [](const Solution& s) {
    EXPECT_NEAR(s.x[0], 2 * test::kGravityStep, kRounding);
    EXPECT_EQ(s.x[1], 0);
    EXPECT_NEAR(s.x[2], test::kGravityStep, kRounding);
  });
  for (Settings settings : {test::PlainSweeps(20), test::AlwaysSteps(20)}) {
    const Solution from_warm_start = test::Solve(settings, scene, {0, 0.5, 0});
    EXPECT_EQ(from_warm_start.x[1], 0.5);
    EXPECT_EQ(test::Solve(settings, scene, {0, -0.5, 0}).x[1], 0);
  }
}

// In whole numbers every product is exact: x = (2, 1) is a fixed point to the bit.
TEST(Solver, StaysAtTheSolutionItIsGiven) {
  const Scene scene = StackOfTwo(1);
  const Solution s = test::Solve(test::PlainSweeps(100), scene, {2, 1});
  EXPECT_EQ(s.x, (std::vector<double>{2, 1}));
  EXPECT_EQ(s.report.sweeps, 1);
  EXPECT_EQ(s.report.stop, StopReason::kStationary);
  const Solution stepped = test::Solve(test::AlwaysSteps(100), scene, {2, 1});
  EXPECT_EQ(stepped.x, (std::vector<double>{2, 1}));
}

TEST(Solver, AWarmStartIsBroughtInsideTheBoundsFirst) {
  Scene scene = Incline(0.4, 0.5);
  scene.rows[0].hi = 4;
  const Solution s = test::Solve(test::PlainSweeps(0), scene, {100, -100, 100});
  EXPECT_EQ(s.x, (std::vector<double>{4, -2, 2}));
  const Solution negative = test::Solve(test::PlainSweeps(0), scene, {-3, -100, 1});
  EXPECT_EQ(negative.x, (std::vector<double>{0, 0, 0}));
}

}  // namespace
}  // namespace cairn
