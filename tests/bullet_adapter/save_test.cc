// SPDX-License-Identifier: MIT
// Saving a world and going back to it. Two ways: with all contacts, as long as the pairs of bodies
// that are near each other stay the same; and from poses and velocities alone, where contacts begin
// anew both at the save and at each load.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "cairn/bullet/constraint_solver.h"
#include "tests/bullet_adapter/any_world.h"
#include "tests/bullet_adapter/scene_world.h"

namespace cairn::test {
namespace {

struct BodyState {
  btTransform pose;
  btVector3 velocity, spin;
};

std::vector<BodyState> SaveBodies(const bench::World& world) {
  std::vector<BodyState> saved;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    saved.push_back(
        {body->getWorldTransform(), body->getLinearVelocity(), body->getAngularVelocity()});
  }
  return saved;
}

/// The pose in full: world, interpolation, inertia in the world.
void LoadBodies(const std::vector<BodyState>& saved, bench::World* world) {
  for (size_t i = 0; i < saved.size(); ++i) {
    btRigidBody* const body = world->dynamic_bodies()[i];
    body->setCenterOfMassTransform(saved[i].pose);
    body->setInterpolationWorldTransform(saved[i].pose);
    body->setLinearVelocity(saved[i].velocity);
    body->setAngularVelocity(saved[i].spin);
    body->setInterpolationLinearVelocity(saved[i].velocity);
    body->setInterpolationAngularVelocity(saved[i].spin);
  }
}

/// All that a world without sleepers and motors has, contacts included.
class Snapshot {
 public:
  explicit Snapshot(bench::World* world) : bodies_(SaveBodies(*world)) {
    btDispatcher* const dispatcher = world->bullet()->getDispatcher();
    for (int i = 0; i < dispatcher->getNumManifolds(); ++i) {
      const btPersistentManifold& manifold = *dispatcher->getManifoldByIndexInternal(i);
      bodies_of_manifolds_.push_back(BodiesOf(manifold));
      counts_.push_back(manifold.getNumContacts());
      for (int k = 0; k < counts_.back(); ++k) points_.push_back(manifold.getContactPoint(k));
    }
    for (const btTypedConstraint* joint : world->joints()) enabled_.push_back(joint->isEnabled());
  }

  /// False if there are other manifolds than there were.
  bool Load(bench::World* world) const {
    LoadBodies(bodies_, world);
    btDispatcher* const dispatcher = world->bullet()->getDispatcher();
    if (dispatcher->getNumManifolds() != static_cast<int>(counts_.size())) return false;
    for (int i = 0; i < dispatcher->getNumManifolds(); ++i) {
      const auto now = BodiesOf(*dispatcher->getManifoldByIndexInternal(i));
      if (now != bodies_of_manifolds_[i]) return false;
    }
    auto point = points_.begin();
    for (int i = 0; i < dispatcher->getNumManifolds(); ++i) {
      btPersistentManifold* const manifold = dispatcher->getManifoldByIndexInternal(i);
      manifold->setNumContacts(counts_[i]);
      for (int k = 0; k < counts_[i]; ++k) manifold->getContactPoint(k) = *point++;
    }
    for (size_t i = 0; i < enabled_.size(); ++i) world->joints()[i]->setEnabled(enabled_[i]);
    return true;
  }

 private:
  using TwoBodies = std::pair<const btCollisionObject*, const btCollisionObject*>;
  static TwoBodies BodiesOf(const btPersistentManifold& manifold) {
    return {manifold.getBody0(), manifold.getBody1()};
  }

  std::vector<BodyState> bodies_;
  std::vector<TwoBodies> bodies_of_manifolds_;
  std::vector<int> counts_;
  std::vector<btManifoldPoint> points_;  ///< of all manifolds, in order
  std::vector<bool> enabled_;
};

std::vector<std::uint64_t> HashesOf(int frames, SceneWorld* world) {
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < frames; ++i) {
    world->world().Step();
    hashes.push_back(bench::StateHash(world->world()));
  }
  return hashes;
}

class SavedScene : public testing::TestWithParam<std::string_view> {};

TEST_P(SavedScene, GoesOnTheSameWayWithItsContacts) {
  bullet::ConstraintSolver solver;
  SceneWorld world(GetParam(), &solver);
  world.Step(40);
  const Snapshot snapshot(&world.world());
  solver.reset();  // what it knows is not in the snapshot
  const auto expected = HashesOf(30, &world);
  for (int again = 0; again < 2; ++again) {
    ASSERT_TRUE(snapshot.Load(&world.world())) << "the scene is too lively for this test";
    solver.reset();
    EXPECT_EQ(HashesOf(30, &world), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, SavedScene,
                         testing::Values("pyramid", "tower", "heavy-top", "wall", "bridge"),
                         SceneTestName());

/// Poses, velocities, and contacts from nothing: every body leaves the world and comes back in the
/// same order, and the broadphase forgets its history while it is empty.
void Load(const std::vector<BodyState>& saved, SceneWorld* scene) {
  bench::World& world = scene->world();
  btDiscreteDynamicsWorld* const bullet = world.bullet();
  std::vector<btCollisionObject*> objects;
  for (int i = 0; i < bullet->getNumCollisionObjects(); ++i) {
    objects.push_back(bullet->getCollisionObjectArray()[i]);
  }
  std::ranges::sort(objects, {}, &btCollisionObject::getWorldArrayIndex);
  for (size_t i = objects.size(); i-- > 0;) {
    bullet->removeRigidBody(btRigidBody::upcast(objects[i]));
  }
  bullet->getBroadphase()->resetPool(bullet->getDispatcher());
  LoadBodies(saved, &world);
  for (btCollisionObject* object : objects) bullet->addRigidBody(btRigidBody::upcast(object));
}

class SavedPoses : public testing::TestWithParam<std::string_view> {};

TEST_P(SavedPoses, GoOnTheSameWayFromFreshContacts) {
  bullet::ConstraintSolver solver;
  SceneWorld world(GetParam(), &solver);
  world.Step(60);
  const auto saved = SaveBodies(world.world());
  Load(saved, &world);
  solver.reset();
  const auto expected = HashesOf(60, &world);
  for (int again = 0; again < 2; ++again) {
    Load(saved, &world);
    solver.reset();
    EXPECT_EQ(HashesOf(60, &world), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, SavedPoses,
                         testing::Values("rubble", "ragdolls", "pyramid", "chain", "wall"),
                         SceneTestName());

}  // namespace
}  // namespace cairn::test
