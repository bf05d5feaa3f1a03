// SPDX-License-Identifier: MIT
// Settings::relax: what takes back errors of position moves bodies, and leaves no velocity.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "cairn/detail/eigen.h"
#include "tests/core/engine/small_world.h"
#include "tests/core/support/manifold_problems.h"

namespace cairn {
namespace {

using test::SmallWorld;
using test::Thing;
using test::Vector3d;

constexpr double kBallRadius = 0.1, kStep = 1 / 60.0;

SmallWorld Relaxing(bool relax = true) {
  SmallWorld world;
  world.solver.settings().relax = relax;
  return world;
}

/// One step of a body at @p position, with @p speed, without gravity.
SmallWorld StepOnce(bool relax, const Vector3d& position, const Velocity& velocity,
                    const std::function<void(SmallWorld*)>& fill) {
  SmallWorld world = Relaxing(relax);
  world.gravity = 0;
  world.things.push_back({.position = position, .velocity = velocity});
  world.Step(fill);
  return world;
}

/// A ball that touches the ground.
void Touches(double restitution, SmallWorld* world) {
  const Vector3d& at = world->things[0].position;
  const std::array points{
      TouchPoint{.position = {at.x(), 0, at.z()}, .depth = kBallRadius - at.y()}};
  world->contacts.Add({.body_a = 0, .centre_a = at, .restitution = restitution, .id = 1}, points);
}

void Holds(const JointKind& kind, SmallWorld* world) {
  world->joints.Add(kind, world->things[0].Side(0, Vector3d::Zero()), {}, 1);
}

// By hand: a depth of 30 mm, less 5 mm of slop, by a fifth: 5 mm.
TEST(Relax, DepthMovesABodyAndLeavesItAtRest) {
  const auto fill = [](SmallWorld* w) { Touches(0, w); };
  const Vector3d deep(0, kBallRadius - 0.03, 0);
  const SmallWorld pushed = StepOnce(false, deep, {}, fill);
  EXPECT_NEAR(pushed.things[0].velocity.linear.y(), 0.005 / kStep, 1e-5);
  const SmallWorld relaxed = StepOnce(true, deep, {}, fill);
  EXPECT_NEAR(relaxed.things[0].position.y(), deep.y() + 0.005, 1e-6);
  EXPECT_NEAR(relaxed.things[0].velocity.linear.y(), 0, 1e-5);
}

// By hand: m g h. What pushed it out is no part of them.
TEST(Relax, ImpulsesAreThoseOfTheVelocity) {
  for (const int substeps : {1, 3}) {
    SmallWorld world = Relaxing();
    world.solver.settings().substeps = substeps;
    world.things.push_back({.mass = 2, .position = {0, kBallRadius - 0.03, 0}});
    world.Step([](SmallWorld* w) { Touches(0, w); });
    EXPECT_NEAR(world.contacts.impulses()[0].normal, 2 * 9.81 * kStep, 1e-4) << substeps;
    EXPECT_NEAR(world.things[0].velocity.linear.y(), 0, 1e-4) << substeps;
    EXPECT_NEAR(world.things[0].position.y(), kBallRadius - 0.025, 1e-5) << substeps;
  }
}

// A fifth of 0.1 m, and of 0.2 rad.
TEST(Relax, JointsCloseAndLeaveTheirBodiesAtRest) {
  SmallWorld world = Relaxing();
  world.gravity = 0;
  world.things.push_back({.position = {0.1, 0, 0}});
  world.things[0].turn = Eigen::AngleAxisd(0.2, Vector3d::UnitY());
  world.Step([](SmallWorld* w) { Holds(FixedJoint(), w); });
  EXPECT_NEAR(world.things[0].position.x(), 0.08, 1e-4);
  EXPECT_NEAR(Eigen::AngleAxisd(world.things[0].turn).angle(), 0.16, 1e-4);
  EXPECT_LE(View(world.things[0].velocity.linear).norm(), 1e-4);
  EXPECT_LE(View(world.things[0].velocity.angular).norm(), 1e-4);
}

TEST(Relax, LimitsAndGearsDoSoToo) {
  const auto fill = [](SmallWorld* w) { Holds(SliderJoint({.hi = 0.5}), w); };
  const SmallWorld world = StepOnce(true, {1, 0, 0}, {}, fill);
  EXPECT_NEAR(world.things[0].position.x(), 0.9, 1e-5);
  EXPECT_NEAR(world.things[0].velocity.linear.x(), 0, 1e-4);
  const auto mesh = [](SmallWorld* w) {
    JointGear wheel, still;
    wheel.side = w->things[0].Side(0, Vector3d::Zero());
    wheel.angle = 0.1;
    w->joints.AddGear(wheel, still, 1);
  };
  const SmallWorld gear = StepOnce(true, Vector3d::Zero(), {}, mesh);
  EXPECT_NEAR(2 * gear.things[0].turn.x(), -0.02, 1e-4);
  EXPECT_NEAR(gear.things[0].velocity.angular.x(), 0, 1e-4);
}

// What is asked for as a velocity stays one: gaps, motors, springs, soft contacts, room to a limit.
TEST(Relax, KeepsWhatTakesBackNoError) {
  const Velocity falls{.linear = {0, -3, 0}}, slides{.linear = {9, 0, 0}};
  struct Case {
    Vector3d position;
    Velocity velocity;
    std::function<void(SmallWorld*)> fill;
  };
  const JointAxis spring{.rest = 0.1, .frequency = 3}, motor{.speed = 2, .max_motor_force = 1e4};
  const std::array cases{
      Case{{0, kBallRadius + 0.02, 0}, falls, [](SmallWorld* w) { Touches(0, w); }},
      Case{{0, kBallRadius - 0.03, 0},
           falls,
           [](SmallWorld* w) {
             w->contacts.options().frequency = 5;
             Touches(0, w);
           }},
      Case{{0, 0, 0}, {}, [&](SmallWorld* w) { Holds(SliderJoint(motor), w); }},
      Case{{0, 0, 0}, {}, [&](SmallWorld* w) { Holds(SliderJoint(spring), w); }},
      Case{{0.45, 0, 0}, slides, [](SmallWorld* w) { Holds(SliderJoint({.hi = 0.5}), w); }}};
  for (size_t i = 0; i < cases.size(); ++i) {
    const auto& [position, velocity, fill] = cases[i];
    const SmallWorld pushed = StepOnce(false, position, velocity, fill);
    const SmallWorld relaxed = StepOnce(true, position, velocity, fill);
    const Vector3d asked = pushed.things[0].velocity.linear;
    EXPECT_GT((asked - View(velocity.linear)).norm(), 0.1) << i << ": it does nothing";
    EXPECT_NEAR((View(relaxed.things[0].velocity.linear) - asked).norm(), 0, 1e-4) << i;
    EXPECT_NEAR((relaxed.things[0].position - pushed.things[0].position).norm(), 0, 1e-5) << i;
  }
}

/// How high a ball of the core alone gets after its first bounce, with a fifth of its depth taken
/// back: bias and restitution as they come [m].
double RawHeight(bool relax, double drop, double rate) {
  Thing ball{.position = {0, kBallRadius + drop, 0}};
  const double h = 1 / rate;
  Solver solver({.relax = relax, .tolerance = 1e-5});
  bool bounced = false;
  double highest = 0;
  for (int frame = 0; frame < 4 * rate; ++frame) {
    const double gap = ball.position.y() - kBallRadius;
    const Body body{.inv_mass = 1,
                    .inv_inertia = Eigen::Matrix3d::Identity(),
                    .velocity = ball.velocity,
                    .impulse = {0, -9.81 * h, 0}};
    const Manifold manifold{.body_a = 0};
    const ContactPoint point{.arm_a = {0, -0.1f, 0},
                             .normal = {0, 1, 0},
                             .bias = static_cast<float>(gap > 0 ? -gap / h : -0.2 * gap / h),
                             .restitution = 1};
    ContactImpulse impulse;
    Velocity velocity;
    const ContactProblem problem{
        .bodies = {&body, 1}, .manifolds = {&manifold, 1}, .points = {&point, 1}, .time_step = h};
    EXPECT_TRUE(solver.Solve(problem, {.points = {&impulse, 1}}, {&velocity, 1}).ok());
    const bool has_means = !solver.mean_velocities().empty();
    ball.position += h * View((has_means ? solver.mean_velocities()[0] : velocity).linear);
    const bool turned = ball.velocity.linear.y() < 0 && velocity.linear.y() > 0;
    ball.velocity = velocity;
    if (bounced && velocity.linear.y() <= 0) break;
    bounced = bounced || turned;
    if (bounced) highest = std::max(highest, ball.position.y() - kBallRadius);
  }
  return highest;
}

TEST(Relax, RestitutionOneRisesToWhereItFellFrom) {
  double worst = 0;
  for (const double rate : {30.0, 60.0, 144.0}) {
    for (const double drop : {1.4, 1.7, 2.0, 2.3, 3.1, 5.0}) {
      const double height = RawHeight(true, drop, rate);
      EXPECT_NEAR(height, drop, 0.01 * drop) << rate << " Hz from " << drop << " m";
      worst = std::max(worst, std::abs(RawHeight(false, drop, rate) - drop) / drop);
    }
  }
  EXPECT_GT(worst, 0.1) << "bias and bounce do not add up without";
}

/// Cubes of 1 m, the first five things: each touches the one below.
void StackCubes(SmallWorld* world) {
  for (int i = 0; i < 5; ++i) {
    const Vector3d centre = world->things[i].position;
    const Vector3d below = i > 0 ? world->things[i - 1].position : Vector3d(0, -0.5, 0);
    std::vector<TouchPoint> points;
    for (std::uint32_t k = 0; k < 4; ++k) {
      const Vector3d corner(k & 1 ? 0.5 : -0.5, -0.5, k & 2 ? 0.5 : -0.5);
      points.push_back({centre + corner, below.y() + 0.5 - (centre.y() - 0.5), k});
    }
    world->contacts.Add({.body_a = i,
                         .body_b = i - 1,
                         .centre_a = centre,
                         .centre_b = below,
                         .id = static_cast<std::uint64_t>(i + 1)},
                        points);
  }
}

/// The same, which overlap by 10 cm each.
SmallWorld SqueezedTower(bool relax) {
  SmallWorld world = Relaxing(relax);
  for (int i = 0; i < 5; ++i) {
    world.things.push_back({.position = {0, 0.4 + 0.9 * i, 0}, .inertia = 1 / 6.0});
  }
  return world;
}

double Fastest(const SmallWorld& world, size_t things) {
  double fastest = 0;
  for (size_t i = 0; i < things; ++i) {
    fastest = std::max(fastest, View(world.things[i].velocity.linear).norm());
  }
  return fastest;
}

// Balls fall by 2 m beside a tower that comes apart.
TEST(Relax, BallsBounceToTheSquareOfRestitutionBesideATower) {
  constexpr std::array kRestitutions{0.0, 0.5, 1.0};
  SmallWorld world = SqueezedTower(true);
  for (int i = 0; i < 3; ++i) {
    world.things.push_back({.position = {5.0 + i, kBallRadius + 2, 0}, .inertia = 0.004});
  }
  struct Bounce {
    bool rises = false, over = false;
    double height = 0;
  } bounces[3];
  for (int frame = 0; frame < 150; ++frame) {
    world.Step([&](SmallWorld* w) {
      StackCubes(w);
      for (int i = 0; i < 3; ++i) {
        const Vector3d& at = w->things[5 + i].position;
        const std::array points{
            TouchPoint{.position = {at.x(), 0, at.z()}, .depth = kBallRadius - at.y()}};
        w->contacts.Add({.body_a = 5 + i,
                         .centre_a = at,
                         .restitution = kRestitutions[i],
                         .id = static_cast<std::uint64_t>(100 + i)},
                        points);
      }
    });
    EXPECT_LE(Fastest(world, 5), 0.02) << frame;
    for (int i = 0; i < 3; ++i) {
      Bounce& bounce = bounces[i];
      const Thing& ball = world.things[5 + i];
      bounce.over = bounce.over || (bounce.rises && ball.velocity.linear.y() <= 0);
      bounce.rises = bounce.rises || ball.velocity.linear.y() > 0.1;
      if (bounce.rises && !bounce.over) {
        bounce.height = std::max(bounce.height, ball.position.y() - kBallRadius);
      }
    }
  }
  EXPECT_FALSE(bounces[0].rises);
  for (int i = 1; i < 3; ++i) {
    const double height = 2 * kRestitutions[i] * kRestitutions[i];
    EXPECT_NEAR(bounces[i].height, height, 0.01 * height) << kRestitutions[i];
  }
}

TEST(Relax, WhatOverlapsComesApartWithoutPopping) {
  for (const bool relax : {false, true}) {
    SmallWorld world = SqueezedTower(relax);
    double fastest = 0;
    for (int frame = 0; frame < 300; ++frame) {
      world.Step(StackCubes);
      fastest = std::max(fastest, Fastest(world, 5));
    }
    if (!relax) {
      EXPECT_GT(fastest, 1);
      continue;
    }
    EXPECT_LE(fastest, 0.02);
    // a slop of 5 mm each is left
    EXPECT_NEAR(world.things[4].position.y(), 4.5 - 5 * 0.005, 0.005);
    EXPECT_LE(world.report.islands[0].speed, 1e-3);
    EXPECT_GT(world.report.islands[0].quiet, 60);
  }
}

/// A random scene with one solution: without friction, and soft everywhere. Some of its points and
/// rows take back errors.
test::ManifoldScene SoftScene(std::uint64_t seed) {
  test::ManifoldScene scene = test::RandomManifolds(12, 20, seed);
  test::AddJoints(8, seed, &scene);
  // velocities are counted from the start of the step
  for (Body& body : scene.bodies) {
    if (!scene.motions.empty()) body.velocity = {};
  }
  std::uint32_t bits = static_cast<std::uint32_t>(seed) * 2654435761u;
  for (Manifold& manifold : scene.manifolds) {
    manifold.soft = true;
    manifold.tangents = 0;
    manifold.speeds = static_cast<std::uint8_t>((bits = bits * 1664525u + 1013904223u) >> 28);
  }
  for (ContactPoint& point : scene.points) {
    point.restitution = point.friction = 0;
    point.compliance = std::max(point.compliance, 0.05f);
  }
  for (Joint& joint : scene.joints) {
    joint.soft = true;
    joint.errors = (bits = bits * 1664525u + 1013904223u) >> 24;
  }
  for (JointRow& row : scene.joint_rows) row.compliance = std::max(row.compliance, 0.05f);
  return scene;
}

/// What its second solve is to solve.
test::ManifoldScene WithoutErrors(test::ManifoldScene scene) {
  for (const Manifold& manifold : scene.manifolds) {
    for (int p = 0; p < manifold.points; ++p) {
      float& bias = scene.points[manifold.first_point + p].bias;
      if ((manifold.speeds >> p & 1) == 0) bias = std::min(bias, 0.0f);
    }
  }
  for (const Joint& joint : scene.joints) {
    for (int i = 0; i < joint.rows; ++i) {
      if ((joint.errors >> i & 1) != 0) scene.joint_rows[joint.first_row + i].target = 0;
    }
  }
  return scene;
}

/// Largest difference, of a scene that is solved alone.
double DifferenceTo(test::ManifoldScene scene, std::span<const Velocity> velocities) {
  Solver solver({.path = Path::kReference, .max_sweeps = 20000, .tolerance = 1e-7});
  std::vector<Velocity> alone(scene.bodies.size());
  EXPECT_TRUE(solver.Solve(scene.problem(), scene.impulses(), alone).ok());
  double largest = 0;
  for (size_t i = 0; i < alone.size(); ++i) {
    largest = std::max({largest, (View(alone[i].linear) - View(velocities[i].linear)).norm(),
                        (View(alone[i].angular) - View(velocities[i].angular)).norm()});
  }
  return largest;
}

TEST(Relax, SolvesBothProblems) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    for (const Path path : {Path::kReference, Path::kFast}) {
      SCOPED_TRACE(seed);
      const bool exact = path == Path::kReference;
      test::ManifoldScene scene = SoftScene(seed);
      const test::ManifoldScene whole = scene, without = WithoutErrors(scene);
      Solver solver(
          {.path = path, .max_sweeps = 20000, .relax = true, .tolerance = exact ? 1e-7 : 2e-5});
      std::vector<Velocity> velocities(scene.bodies.size());
      const Report report = solver.Solve(scene.problem(), scene.impulses(), velocities);
      ASSERT_TRUE(report.ok()) << Describe(report);
      const double near = exact ? 1e-5 : 2e-3;
      EXPECT_LE(DifferenceTo(whole, solver.mean_velocities()), near);
      EXPECT_LE(DifferenceTo(without, velocities), near);
      EXPECT_GT(DifferenceTo(whole, velocities), 0.01) << "nothing was relaxed";
    }
  }
}

TEST(Relax, WithoutErrorsIsTheSameToTheBit) {
  const auto fill = [](SmallWorld* w) { Touches(0, w); };
  const Velocity falls{.linear = {0.5, -3, 0}, .angular = {0, 400, 1}};
  const SmallWorld one = StepOnce(false, {0, kBallRadius + 0.01, 0}, falls, fill);
  const SmallWorld two = StepOnce(true, {0, kBallRadius + 0.01, 0}, falls, fill);
  EXPECT_EQ(one.things[0].velocity.linear, two.things[0].velocity.linear);
  EXPECT_EQ(one.things[0].velocity.angular, two.things[0].velocity.angular);
  EXPECT_EQ(one.things[0].position, two.things[0].position);
  EXPECT_EQ(one.things[0].turn.coeffs(), two.things[0].turn.coeffs());
  EXPECT_EQ(one.report.sweeps, two.report.sweeps);
}

TEST(Relax, DoesSoInEachOfSubsteps) {
  SmallWorld world = Relaxing();
  world.gravity = 0;
  world.solver.settings().substeps = 4;
  world.things.push_back({.position = {0, kBallRadius - 0.03, 0}});
  world.Step([](SmallWorld* w) { Touches(0, w); });
  EXPECT_NEAR(world.things[0].position.y(), kBallRadius - 0.025, 1e-5);
  EXPECT_NEAR(world.things[0].velocity.linear.y(), 0, 1e-4);
}

// 5 mm a step are 0.3 m/s, though the body keeps no velocity: it is not to fall asleep on the way.
TEST(Relax, WhatIsMovedOutIsNotQuiet) {
  SmallWorld world = Relaxing();
  world.things.push_back({.position = {0, kBallRadius - 0.09, 0}});
  for (int i = 0; i < 10; ++i) world.Step([](SmallWorld* w) { Touches(0, w); });
  EXPECT_GT(world.report.islands[0].speed, 0.1);
  EXPECT_EQ(world.report.islands[0].quiet, 0);
  for (int i = 0; i < 60; ++i) world.Step([](SmallWorld* w) { Touches(0, w); });
  EXPECT_GT(world.report.islands[0].quiet, 10);
}

TEST(Relax, StaysInABudgetOfWork) {
  for (const std::int64_t work : {0, 20, 100, 1000}) {
    SmallWorld world = Relaxing();
    world.solver.settings().budget = Budget::Work(work);
    world.things.push_back({.position = {0, kBallRadius - 0.03, 0}});
    world.Step([](SmallWorld* w) { Touches(0, w); });
    // a sweep that is begun in time is finished: three rows
    EXPECT_LE(world.report.work, std::max<std::int64_t>(work + 3, 2 * 2 * 3)) << work;
  }
}

TEST(Relax, IsOffInAReplay) {
  const Replay replay;
  Settings settings;
  settings.relax = true;
  EXPECT_EQ(FindBadSetting(settings).name, nullptr);
  settings.tuning.replay = &replay;
  EXPECT_EQ(Describe(FindBadSetting(settings)), "relax is 1, must be 0 in a replay");
}

}  // namespace
}  // namespace cairn
