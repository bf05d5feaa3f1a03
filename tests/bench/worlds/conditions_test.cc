// SPDX-License-Identifier: MIT
// What worlds may be on top of what is drawn.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/facts.h"
#include "worlds/random_world.h"
#include "worlds/trial.h"

namespace cairn::bench {
namespace {

constexpr bool kIsFloat = sizeof(btScalar) == sizeof(float);

const Variant& Cairn() { return CairnVariants().front(); }

// The same worlds, but for what their bodies may not do.
TEST(Locks, AreDrawnApartFromTheWorld) {
  int locked = 0, free = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    btSequentialImpulseConstraintSolver solver;
    const RandomWorld plain({.seed = seed}, &solver), locks({.seed = seed, .locks = true}, &solver);
    EXPECT_EQ(StateHash(plain.world()), StateHash(locks.world())) << seed;
    for (const btRigidBody* body : locks.world().dynamic_bodies()) {
      const btVector3 all(1, 1, 1);
      const bool any = body->getLinearFactor() != all || body->getAngularFactor() != all;
      ++(any ? locked : free);
    }
    for (const btRigidBody* body : plain.world().dynamic_bodies()) {
      EXPECT_EQ(body->getAngularFactor(), btVector3(1, 1, 1));
    }
  }
  EXPECT_GT(locked, free);
  EXPECT_GT(free, 0);
}

// The same worlds, but for masses.
TEST(Heavy, LoadsAreDrawnApartFromTheWorld) {
  int heavier = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    btSequentialImpulseConstraintSolver solver;
    const RandomWorld plain({.seed = seed}, &solver), heavy({.seed = seed, .heavy = true}, &solver);
    EXPECT_EQ(StateHash(plain.world()), StateHash(heavy.world())) << seed;
    const auto of_plain = plain.world().dynamic_bodies(), of_heavy = heavy.world().dynamic_bodies();
    ASSERT_EQ(of_plain.size(), of_heavy.size());
    for (size_t i = 0; i < of_plain.size(); ++i) {
      const double ratio =
          static_cast<double>(of_heavy[i]->getMass()) / static_cast<double>(of_plain[i]->getMass());
      if (ratio == 1) continue;
      ++heavier;
      EXPECT_GT(ratio, 9.99) << seed;
      EXPECT_LT(ratio, 10'010) << seed;
    }
  }
  EXPECT_GT(heavier, 20);
}

/// Where the bodies of a world are after some steps [m].
std::vector<btVector3> PlacesAfter(int steps, const WorldSeed& seed) {
  btSequentialImpulseConstraintSolver solver;
  RandomWorld world(seed, &solver);
  for (int i = 0; i < steps; ++i) world.Step();
  std::vector<btVector3> places;
  for (const btRigidBody* body : world.world().dynamic_bodies()) {
    places.push_back(body->getCenterOfMassPosition() / static_cast<btScalar>(seed.unit));
  }
  return places;
}

// Joints, motors, springs, margins and gravity of all kinds: what one of them forgets is seen in
// few steps. Where bodies rest on each other Bullet itself has speeds in metres: those from which
// on friction goes the way of sliding.
TEST(Units, AreCountedInByBulletAsInMetres) {
  std::map<std::string_view, btScalar> least;
  int apart = 0;
  constexpr int kWorlds = 160;
  for (std::uint64_t seed = 0; seed < kWorlds; ++seed) {
    const std::vector<btVector3> in_metres = PlacesAfter(10, {.seed = seed, .unit = 1});
    const std::vector<btVector3> places = PlacesAfter(10, {.seed = seed, .unit = 128});
    ASSERT_EQ(places.size(), in_metres.size()) << seed;
    btScalar furthest = 0;
    for (size_t i = 0; i < places.size(); ++i) {
      furthest = btMax(furthest, places[i].distance(in_metres[i]));
    }
    apart += furthest > btScalar(0.001) ? 1 : 0;
    btScalar& of_kind = least.try_emplace(KindOf(seed).name, furthest).first->second;
    of_kind = btMin(of_kind, furthest);
  }
  EXPECT_LT(apart, kWorlds / 5);
  for (const auto& [kind, distance] : least) EXPECT_LT(distance, btScalar(0.001)) << kind;
}

// In centimetres Cairn took a third of its steps fewer, and gaps of joints were half as large
// again.
TEST(Units, DoNotChangeWhatCairnDoes) {
  double steps = 0, steps_in_units = 0, ratio = 0;
  int gaps = 0;
  for (std::uint64_t seed = 0; seed < 160; ++seed) {
    TrialOptions options;
    options.world.seed = seed;
    options.seconds = 0.6;
    options.audit_every = 0;
    const Trial in_metres = RunTrial(options, Cairn());
    options.world.unit = 128;
    const Trial in_units = RunTrial(options, Cairn());
    steps += in_metres.steps_kept;
    steps_in_units += in_units.steps_kept;
    if (!(in_metres.gap > 1e-3 && in_units.gap > 1e-3)) continue;
    ratio += std::log(in_units.gap / in_metres.gap);
    ++gaps;
  }
  ASSERT_GT(gaps, 30);
  EXPECT_NEAR(steps_in_units / steps, 1, 0.1);
  EXPECT_NEAR(std::exp(ratio / gaps), 1, 0.1);
}

// Whatever else happens, mass changes in the same way with every solver.
TEST(Played, IsTheSameWithEverySolver) {
  int changed = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    btSequentialImpulseConstraintSolver bullet;
    const auto cairn = Cairn().make();
    RandomWorld one({.seed = seed, .played = true}, &bullet),
        other({.seed = seed, .played = true}, cairn.get());
    const RandomWorld plain({.seed = seed}, &bullet);
    EXPECT_EQ(StateHash(plain.world()), StateHash(one.world())) << seed << ": from the start on";
    for (int frame = 0; frame < one.Frames(0.25); ++frame) {
      one.Step();
      other.Step();
    }
    const auto ours = one.world().dynamic_bodies(), theirs = other.world().dynamic_bodies(),
               before = plain.world().dynamic_bodies();
    ASSERT_EQ(ours.size(), theirs.size());
    for (size_t i = 0; i < ours.size(); ++i) {
      EXPECT_EQ(ours[i]->getMass(), theirs[i]->getMass()) << seed;
      changed += ours[i]->getMass() != before[i]->getMass();
    }
  }
  EXPECT_GT(changed, 5);
}

// Strained bodies gave the momentum of raised inertia to what stopped their spin: these came to
// 1,360 and 249 m/s, where they come to 8 and 16 with 10,000 of Bullet's iterations.
TEST(Played, WorldsDoNotFlyApart) {
  TrialOptions options;
  options.world = {.seed = kIsFloat ? 7360u : 1080u, .played = true};
  options.seconds = 3;
  EXPECT_LT(RunTrial(options, Cairn()).fastest, Trial::kTooFast);
}

// Bodies are pulled away from where they would be, and nothing stays behind.
TEST(Dragged, BodiesFollowAMouseThatLetsGo) {
  int pulled = 0, held = 0, steps = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const auto cairn = Cairn().make(), plain_solver = Cairn().make();
    RandomWorld world({.seed = seed, .dragged = true}, cairn.get()),
        plain({.seed = seed}, plain_solver.get());
    EXPECT_EQ(StateHash(plain.world()), StateHash(world.world())) << seed << ": from the start on";
    for (int frame = 0; frame < world.Frames(1); ++frame, ++steps) {
      world.Step();
      plain.Step();
      const auto joints = static_cast<int>(world.world().joints().size());
      const int more = world.world().bullet()->getNumConstraints() - joints;
      ASSERT_GE(more, 0);
      ASSERT_LE(more, 1);
      held += more;
    }
    pulled += StateHash(plain.world()) != StateHash(world.world());
  }
  EXPECT_GT(pulled, 20);
  EXPECT_GT(held, steps / 10);
  EXPECT_LT(held, steps * 9 / 10);
}

int Kinematic(const World& world) {
  const btCollisionObjectArray& objects = world.bullet()->getCollisionObjectArray();
  int count = 0;
  for (int i = 0; i < objects.size(); ++i) count += objects[i]->isKinematicObject() ? 1 : 0;
  return count;
}

// Two plates at a time, which come, press and go.
TEST(Pressed, PlatesPressBodiesAndGoAgain) {
  int presses = 0, pressed = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const auto cairn = Cairn().make(), plain_solver = Cairn().make();
    RandomWorld world({.seed = seed, .pressed = true}, cairn.get()),
        plain({.seed = seed}, plain_solver.get());
    EXPECT_EQ(StateHash(plain.world()), StateHash(world.world())) << seed << ": from the start on";
    int plates = 0;
    for (int frame = 0; frame < world.Frames(3); ++frame) {
      world.Step();
      plain.Step();
      const int before = std::exchange(plates, Kinematic(world.world()));
      ASSERT_TRUE(plates == 0 || plates == 2);
      presses += before == 0 && plates == 2;
    }
    pressed += StateHash(plain.world()) != StateHash(world.world());
    EXPECT_EQ(world.world().dynamic_bodies().size(), plain.world().dynamic_bodies().size());
  }
  EXPECT_GT(presses, 50);
  EXPECT_GT(pressed, 30);
}

// Bullet tells bodies of joints only where these keep them from colliding.
TEST(Colliding, BodiesKnowNothingOfTheirJoints) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    btSequentialImpulseConstraintSolver solver;
    RandomWorld world({.seed = seed, .colliding = true}, &solver), plain({.seed = seed}, &solver);
    ASSERT_EQ(world.world().bullet()->getNumConstraints(),
              plain.world().bullet()->getNumConstraints());
    for (const btRigidBody* body : world.world().dynamic_bodies()) {
      EXPECT_EQ(body->getNumConstraintRefs(), 0) << seed;
    }
    const auto joints = world.world().joints();
    for (int i = 0; i < static_cast<int>(joints.size()); ++i) {
      EXPECT_EQ(world.world().bullet()->getConstraint(i), joints[i]) << "in their order";
    }
  }
}

TEST(Moving, GroundIsKinematicAndGoesToAndFro) {
  int together = 0, apart = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    btSequentialImpulseConstraintSolver solver;
    const RandomWorld plain({.seed = seed}, &solver);
    RandomWorld moving({.seed = seed, .moving = true}, &solver);
    EXPECT_EQ(StateHash(plain.world()), StateHash(moving.world())) << seed;
    std::vector<const btCollisionObject*> ground;
    std::vector<btVector3> places;
    const btCollisionObjectArray& objects = moving.world().bullet()->getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
      EXPECT_FALSE(objects[i]->isStaticObject()) << seed;
      if (!objects[i]->isKinematicObject()) continue;
      ground.push_back(objects[i]);
      places.push_back(objects[i]->getWorldTransform().getOrigin());
    }
    for (int frame = 0; frame < moving.Frames(0.4); ++frame) moving.Step();
    bool stiff = true;
    for (size_t i = 0; i < ground.size(); ++i) {
      const btVector3 at = ground[i]->getWorldTransform().getOrigin();
      EXPECT_NE(at, places[i]) << seed;
      const btScalar far = at.distance(ground[0]->getWorldTransform().getOrigin());
      if (std::abs(far - places[i].distance(places[0])) > btScalar(1e-3)) stiff = false;
    }
    if (ground.size() > 1) ++(stiff ? together : apart);
  }
  EXPECT_GT(together, 5);
  EXPECT_GT(apart, 5);
}

TEST(Conditions, AreNamedOnceAndSayTheirOptions) {
  std::set<std::string> names;
  WorldSeed all{.unit = 100};
  std::string options;
  for (const Condition& condition : Conditions()) {
    EXPECT_TRUE(names.insert(condition.name).second);
    EXPECT_FALSE(all.*condition.on) << "two names for one condition";
    all.*condition.on = true;
    options += " --" + condition.name;
  }
  EXPECT_EQ(OptionsOf(all), options + " --unit 100");
  EXPECT_EQ(OptionsOf({}), "");
}

}  // namespace
}  // namespace cairn::bench
