// SPDX-License-Identifier: MIT
// Contacts from what an engine knows: the law of the bias, bounces, soft contacts, warm starts.
#include "cairn/contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include "cairn/detail/eigen.h"
#include "tests/core/engine/small_world.h"

namespace cairn {
namespace {

using test::SmallWorld;
using test::Thing;
using test::Vector3d;

constexpr double kRadius = 0.1;

/// The ball of that place, and the ground.
Touch OnGround(const SmallWorld& world, int body) {
  return {.body_a = body,
          .centre_a = world.things[body].position,
          .normal = {0, 1, 0},
          .id = static_cast<std::uint64_t>(body + 1)};
}

TouchPoint Lowest(const SmallWorld& world, int body) {
  const Vector3d& at = world.things[body].position;
  return {.position = {at.x(), 0, at.z()}, .depth = kRadius - at.y()};
}

/// The highest that a ball gets after its first bounce, above where it lies [m].
double BounceHeight(double restitution, double drop, double rate, int substeps = 1) {
  SmallWorld world;
  world.solver.settings().substeps = substeps;
  world.h = 1 / rate;
  world.things.push_back({.position = {0, kRadius + drop, 0}, .inertia = 0.004});
  bool bounced = false;
  double highest = 0;
  for (int frame = 0; frame < 3 * rate; ++frame) {
    const double before = world.things[0].velocity.linear.y();
    world.Step([&](SmallWorld* w) {
      Touch touch = OnGround(*w, 0);
      touch.restitution = restitution;
      const std::array points{Lowest(*w, 0)};
      w->contacts.Add(touch, points);
    });
    const double after = world.things[0].velocity.linear.y();
    if (bounced && after <= 0) break;
    bounced = bounced || (before < 0 && after > 0);
    if (bounced) highest = std::max(highest, world.things[0].position.y() - kRadius);
  }
  return highest;
}

TEST(Contacts, BounceToTheSquareOfRestitutionTimesTheHeight) {
  for (const double rate : {30.0, 60.0, 144.0}) {
    for (const double drop : {2.0, 1.37, 5.0}) {
      for (const double restitution : {0.5, 0.8, 1.0}) {
        const double expected = restitution * restitution * drop;
        // a step ends up to g h^2 / 8 below the top
        const double seen = 9.81 / (rate * rate) / 8;
        EXPECT_NEAR(BounceHeight(restitution, drop, rate), expected, 0.01 * expected + seen)
            << restitution << " from " << drop << " m at " << rate << " Hz";
      }
    }
  }
  // none, but for depth that is taken back
  EXPECT_LE(BounceHeight(0, 2, 60), 1e-3);
}

TEST(Contacts, BounceAsHighWithSubsteps) {
  for (const int substeps : {2, 4, 8}) {
    for (const double restitution : {0.5, 1.0}) {
      const double expected = restitution * restitution * 2;
      EXPECT_NEAR(BounceHeight(restitution, 2, 60, substeps), expected,
                  0.01 * expected + 9.81 / 3600 / 8)
          << restitution << ", " << substeps << " substeps";
    }
  }
}

/// The bias of a point of that depth of a body at rest without gravity.
double BiasOf(const ContactOptions& options, double depth, const Velocity& velocity = {}) {
  const std::array bodies{Body{.inv_mass = 1, .velocity = velocity}};
  Contacts contacts(options);
  contacts.Begin({bodies, 0.01});
  const std::array points{TouchPoint{.depth = depth}};
  contacts.Add({.body_a = 0, .restitution = 0.5}, points);
  return contacts.points()[0].bias;
}

TEST(Contacts, LetGapsCloseAndTakeDepthBack) {
  const ContactOptions options{.slop = 0.01, .erp = 0.2, .max_push = 3};
  EXPECT_FLOAT_EQ(BiasOf(options, -0.05), -5);  // 5 cm in 0.01 s
  EXPECT_EQ(BiasOf(options, 0), 0);
  EXPECT_EQ(BiasOf(options, 0.01), 0);
  EXPECT_FLOAT_EQ(BiasOf(options, 0.06), 1);  // a fifth of 5 cm in 0.01 s
  EXPECT_FLOAT_EQ(BiasOf(options, 0.5), 3);
}

// Of 5 cm below the slop a fifth, and no more than 3 m/s for 0.01 s.
TEST(Contacts, SayHowDeepTheyAre) {
  const std::array bodies{Body{.inv_mass = 1}};
  Contacts contacts({.slop = 0.01, .erp = 0.2, .max_push = 3});
  const auto add = [&contacts](double depth) {
    contacts.Add({.body_a = 0}, std::array{TouchPoint{.depth = depth}});
  };
  contacts.Begin({bodies, 0.01});
  add(-0.05);
  EXPECT_EQ(contacts.deepest().largest, 0);
  add(0.06);
  add(0.02);
  EXPECT_EQ(contacts.deepest().largest, 0.06);
  EXPECT_NEAR(contacts.deepest().taken_back, 0.01, 1e-12);
  add(0.5);
  EXPECT_EQ(contacts.deepest().largest, 0.5);
  EXPECT_NEAR(contacts.deepest().taken_back, 0.03, 1e-12);
  contacts.Begin({bodies, 0.01});
  add(0.005);
  EXPECT_EQ(contacts.deepest().largest, 0.005);
  EXPECT_EQ(contacts.deepest().taken_back, 0);
}

// By hand: of 6 cm below the slop a fifth in 1/60 s, 0.72 m/s. A ball that nothing holds down rises
// so; without a sweep it does nothing.
TEST(Contacts, SayInTheReportWhatIsTakenBack) {
  for (const int sweeps : {0, 100}) {
    for (const bool relax : {false, true}) {
      SmallWorld world;
      world.gravity = 0;
      world.solver.settings().relax = relax;
      world.solver.settings().max_sweeps = sweeps;
      world.things = {{.position = {0, 0.095, 0}}, {.position = {0, 0.035, 0}}};
      world.Step([](SmallWorld* w) {
        for (const int body : {0, 1}) {
          w->contacts.Add(OnGround(*w, body), std::array{Lowest(*w, body)});
        }
      });
      EXPECT_NEAR(world.report.depth.asked, 0.72, 1e-6);
      EXPECT_NEAR(world.report.depth.done, sweeps == 0 ? 0 : 0.72, 1e-4) << relax;
      EXPECT_EQ(world.report.gap.asked, 0);
    }
  }
}

// A bounce and what a soft contact gives are speeds, not depth; a gap takes nothing back.
TEST(Contacts, AskTheReportForNoSpeeds) {
  SmallWorld world;
  world.things = {{.position = {0, kRadius, 0}, .velocity = {.linear = {0, -3, 0}}},
                  {.position = {5, kRadius + 0.01, 0}}};
  world.Step([](SmallWorld* w) {
    for (const int body : {0, 1}) {
      Touch touch = OnGround(*w, body);
      touch.restitution = 0.5;
      w->contacts.Add(touch, std::array{Lowest(*w, body)});
    }
  });
  EXPECT_GT(world.things[0].velocity.linear.y(), 1);
  EXPECT_EQ(world.report.depth.asked, 0);
}

TEST(Contacts, BounceFromTheSpeedThatTheyHaveWhereTheGapCloses) {
  const ContactOptions options{.min_bounce = 1};
  const auto falls = [](double speed) { return Velocity{.linear = {0, -speed, 0}}; };
  EXPECT_FLOAT_EQ(BiasOf(options, 0, falls(2)), 1);       // half of 2 m/s
  EXPECT_FLOAT_EQ(BiasOf(options, -0.01, falls(2)), 1);   // closes in this step
  EXPECT_FLOAT_EQ(BiasOf(options, -0.03, falls(2)), -3);  // does not
  EXPECT_EQ(BiasOf(options, 0, falls(0.9)), 0);           // too slow
  EXPECT_EQ(BiasOf(options, 0, falls(-2)), 0);            // leaves
}

// Falling at 3 m/s, a step covers 5 cm: what is 8 cm away is not reached, the others bounce.
TEST(Contacts, SayWhichBiasIsASpeed) {
  const std::array bodies{Body{.inv_mass = 1, .velocity = {.linear = {0, -3, 0}}}};
  const std::array points{TouchPoint{.depth = -0.08}, TouchPoint{.depth = -0.02},
                          TouchPoint{.depth = 0.03}};
  Contacts contacts;
  for (const auto& [restitution, frequency, speeds] :
       {std::tuple(0.5, 0.0, 6), {0.0, 0.0, 0}, {0.0, 5.0, 4}}) {
    contacts.options().frequency = frequency;
    contacts.Begin({bodies, 1 / 60.0});
    contacts.Add({.body_a = 0, .restitution = restitution}, points);
    ASSERT_EQ(contacts.manifolds().size(), size_t{1});
    EXPECT_EQ(contacts.manifolds()[0].speeds, speeds) << restitution << ' ' << frequency;
  }
}

TEST(Contacts, SoftOnesGiveLikeASpring) {
  for (const double frequency : {3.0, 8.0}) {
    SmallWorld world;
    world.contacts.options() = {.frequency = frequency, .damping_ratio = 1};
    world.things.push_back({.mass = 3, .position = {0, kRadius, 0}});
    for (int frame = 0; frame < 180; ++frame) {
      world.Step([](SmallWorld* w) {
        const std::array points{Lowest(*w, 0)};
        w->contacts.Add(OnGround(*w, 0), points);
      });
    }
    // k d = m g, k = m (2 pi f)^2
    const double omega = 2 * 3.14159265 * frequency;
    const double depth = kRadius - world.things[0].position.y();
    EXPECT_NEAR(depth - world.contacts.options().slop, 9.81 / (omega * omega), 2e-5);
  }
}

TEST(Contacts, StartFromWhatTheSameFeatureExerted) {
  const std::array bodies{Body{.inv_mass = 1}, Body{.inv_mass = 1}};
  Contacts contacts;
  const StepInput step{bodies, 0.01};
  const auto point = [](std::uint32_t feature) { return TouchPoint{.feature = feature}; };
  const Touch known{.body_a = 0, .id = 7}, nameless{.body_a = 1};
  contacts.Begin(step);
  contacts.Add(known, std::array{point(1), point(2)});
  contacts.Add(nameless, std::array{point(1)});
  for (size_t i = 0; i < 3; ++i) contacts.impulses()[i].normal = 1 + static_cast<float>(i);

  contacts.Begin(step);
  contacts.Add(nameless, std::array{point(1)});
  contacts.Add(known, std::array{point(2), point(3), point(1)});
  EXPECT_EQ(contacts.impulses()[0].normal, 0);
  EXPECT_EQ(contacts.impulses()[1].normal, 2);
  EXPECT_EQ(contacts.impulses()[2].normal, 0);
  EXPECT_EQ(contacts.impulses()[3].normal, 1);
}

TEST(Contacts, StartALongerStepFromMore) {
  const std::array bodies{Body{.inv_mass = 1}};
  const Touch touch{.body_a = 0, .friction = 1, .id = 7};
  Contacts contacts;
  contacts.Begin({bodies, 0.01});
  contacts.Add(touch, std::array{TouchPoint{.feature = 1}});
  contacts.impulses()[0].normal = 2;
  contacts.impulses()[0].tangential[1] = 3;
  contacts.impulses()[0].heading = 4;
  contacts.Begin({bodies, 0.005});
  contacts.Add(touch, std::array{TouchPoint{.feature = 1}});
  EXPECT_FLOAT_EQ(contacts.impulses()[0].normal, 1);
  EXPECT_FLOAT_EQ(contacts.impulses()[0].tangential[1], 1.5f);
  EXPECT_EQ(contacts.impulses()[0].heading, 4);
}

// An engine that is paused may make steps that take no time.
TEST(Contacts, TakeNothingBackInAStepOfNoTime) {
  SmallWorld world;
  for (const double depth : {0.05, 0.0, -0.05}) {
    world.things.push_back({.position = {0, kRadius - depth, 0}, .inertia = 0.004});
  }
  world.h = 0;
  world.Step([](SmallWorld* w) {
    for (int body = 0; body < 3; ++body) {
      const std::array points{Lowest(*w, body)};
      w->contacts.Add(OnGround(*w, body), points);
    }
    // stretched, and beyond a limit
    const JointSide side = w->things[0].Side(0, {0, 1, 0});
    w->joints.Add(SliderJoint({.lo = 0.5, .hi = 1, .speed = 3, .max_motor_force = 10}), side, {},
                  1);
    w->joints.AddDistance({.rest = 3, .frequency = 2}, side, {}, 2);
  });
  for (const Thing& thing : world.things) EXPECT_EQ(View(thing.velocity.linear).norm(), 0);
}

TEST(Contacts, LeaveOutWhatIsFarAndCutWhatIsMany) {
  const std::array bodies{Body{.inv_mass = 1}};
  Contacts contacts;
  contacts.Begin({bodies, 0.01});
  std::vector<TouchPoint> points(7);
  points[3].depth = -0.2;
  contacts.Add({.body_a = 0}, points);
  ASSERT_EQ(contacts.manifolds().size(), 2u);
  EXPECT_EQ(contacts.manifolds()[0].points, 4);
  EXPECT_EQ(contacts.manifolds()[1].points, 2);
  EXPECT_EQ(contacts.manifolds()[1].first_point, 4);
  EXPECT_EQ(contacts.points().size(), 6u);

  contacts.Begin({bodies, 0.01});
  contacts.Add({.body_a = 0}, std::array{points[3]});
  EXPECT_TRUE(contacts.manifolds().empty());
}

TEST(Contacts, CarryWhatStandsOnAPlatform) {
  SmallWorld world;
  world.things.push_back({.mass = 0, .velocity = {.linear = {0.5, 1, 0}}});
  world.things.push_back({.position = {0, kRadius, 0}, .inertia = 1e6});
  for (int frame = 0; frame < 60; ++frame) {
    world.Step([](SmallWorld* w) {
      const Vector3d lift = w->things[0].position, ball = w->things[1].position;
      const std::array points{TouchPoint{.position = ball - kRadius * Vector3d::UnitY(),
                                         .depth = lift.y() + kRadius - ball.y()}};
      w->contacts.Add({.body_a = 1, .body_b = 0, .centre_a = ball, .centre_b = lift, .id = 1},
                      points);
    });
  }
  EXPECT_EQ(world.things[0].velocity.linear, Vector3d(0.5, 1, 0));
  EXPECT_NEAR((View(world.things[1].velocity.linear) - Vector3d(0.5, 1, 0)).norm(), 0, 1e-4);
}

TEST(Contacts, OfTwoBodiesThatCannotMoveDoNothing) {
  SmallWorld world;
  world.things.assign(2, {.mass = 0, .velocity = {.linear = {0, -1, 0}}});
  world.things[1].velocity = {};
  world.Step([](SmallWorld* w) {
    w->contacts.Add({.body_a = 0, .body_b = 1}, std::array{TouchPoint{.depth = 0.1}});
  });
  EXPECT_EQ(world.things[0].velocity.linear.y(), -1);
}

}  // namespace
}  // namespace cairn
