// SPDX-License-Identifier: MIT
// The rows of Mode::kFast against those that Bullet's own set-up makes from the same state.
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <string_view>

#include "tests/bullet_adapter/joint_world.h"
#include "tests/bullet_adapter/row_oracle.h"
#include "tests/bullet_adapter/scene_world.h"

namespace cairn::test {
namespace {

using bench::At;
using bench::Substep;
using bench::World;

void AsItIs(const Substep&) {}

class RowsOfScene : public testing::TestWithParam<std::string_view> {};

TEST_P(RowsOfScene, AreBullets) {
  const auto scene = bench::Make(*bench::FindScene(GetParam()));
  const RowCounts counts =
      ExpectBulletsRowsInWorld([&](World* world) { scene->Build(world, {}); }, AsItIs, 60, 6);
  EXPECT_GT(counts.joints + counts.normals, 0);
  if (counts.normals > 0) {
    EXPECT_GT(counts.points, counts.normals / 2);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, RowsOfScene, testing::ValuesIn(SceneNames()), SceneTestName());

class RowsOfJoint : public testing::TestWithParam<JointKind> {};

TEST_P(RowsOfJoint, AreBullets) {
  const RowCounts counts = ExpectBulletsRowsInWorld(
      [&](World* world) { BuildJointWorld(GetParam(), world); }, AsItIs, 60, 1);
  EXPECT_GT(counts.joints, 0);
  EXPECT_GT(counts.compact, 0);
  EXPECT_EQ(counts.compact + counts.locked, counts.joints);
}

TEST_P(RowsOfJoint, AreBulletsWithSoftnessAndDampingOfTheWorld) {
  ExpectBulletsRowsInWorld(
      [&](World* world) {
        BuildJointWorld(GetParam(), world);
        world->solver_info().m_globalCfm = btScalar(1e-3);
        world->solver_info().m_damping = btScalar(0.8);
        world->solver_info().m_erp = btScalar(0.4);
      },
      AsItIs, 60, 1);
}

struct NameOfCase {
  template <class Info>
  std::string operator()(const Info& info) const {
    return std::string(info.param.name);
  }
};

INSTANTIATE_TEST_SUITE_P(Every, RowsOfJoint, testing::ValuesIn(JointKinds()), NameOfCase());

/// Bodies of several shapes that fall, slide, roll and bounce on ground, walls and each other.
void BuildTumbling(World* world) {
  world->AddPit(3, 1);
  for (int i = 0; i < 12; ++i) {
    const World::Placing placing{
        .mass = btScalar(1 + i % 3),
        .pose = At(btScalar(i % 4) - btScalar(1.5), btScalar(0.4) + btScalar(i / 4) * btScalar(0.8),
                   btScalar(i % 3) - 1),
        .surface = {.friction = btScalar(0.6),
                    .rolling_friction = i % 2 == 0 ? btScalar(0.1) : 0,
                    .spinning_friction = btScalar(0.05)}};
    btRigidBody* const body =
        i % 3 == 0 ? world->AddSphere(btScalar(0.4), placing)
                   : world->AddBox({btScalar(0.4), btScalar(0.2), btScalar(0.6)}, placing);
    body->setLinearVelocity({btScalar(i) - 5, -1, btScalar(0.5) * btScalar(i)});
    body->setAngularVelocity({btScalar(i), 1, -1});
    body->setRestitution(btScalar(0.7));
  }
  for (int i = 0; i < world->bullet()->getNumCollisionObjects(); ++i) {
    btCollisionObject* const object = world->bullet()->getCollisionObjectArray()[i];
    object->setRestitution(btScalar(0.8));
    object->setRollingFriction(btScalar(0.2));
    object->setSpinningFriction(btScalar(0.1));
  }
}

/// Friction does not see what torques add, normals do.
void WithTorques(const Substep& substep) {
  for (btRigidBody* body : substep.bodies()) {
    body->clearForces();
    body->applyCentralForce({1, btScalar(-9.81) / body->getInvMass(), 2});
    body->applyTorque({30, 20, -10});
  }
}

/// A world, and what is changed in each of its states before rows are made.
struct Feature {
  std::string_view name;
  std::function<void(World*)> build;
  ChangeState change = WithTorques;
};

/// For messages of tests.
void PrintTo(const Feature& feature, std::ostream* out) { *out << feature.name; }

Feature Mode(std::string_view name, int added, int removed) {
  return {name, [=](World* world) {
            BuildTumbling(world);
            int& mode = world->solver_info().m_solverMode;
            mode = (mode | added) & ~removed;
          }};
}

Feature Info(std::string_view name, const std::function<void(btContactSolverInfo*)>& set) {
  return {name, [=](World* world) {
            BuildTumbling(world);
            set(&world->solver_info());
          }};
}

Feature EachBody(std::string_view name, const std::function<void(btRigidBody*)>& set) {
  return {name, [=](World* world) {
            BuildTumbling(world);
            for (btRigidBody* body : world->dynamic_bodies()) set(body);
          }};
}

/// @param added  to the solver mode of the world
Feature EachPoint(std::string_view name, int added,
                  const std::function<void(btManifoldPoint*)>& set) {
  Feature feature = Mode(name, added, 0);
  feature.change = [=](const Substep& substep) {
    for (const Substep::Group& group : substep.groups()) {
      for (btPersistentManifold* manifold : group.manifolds) {
        for (int i = 0; i < manifold->getNumContacts(); ++i) set(&manifold->getContactPoint(i));
      }
    }
  };
  return feature;
}

Feature FlaggedPoints(std::string_view name, int flags) {
  return EachPoint(name, 0, [=](btManifoldPoint* point) {
    point->m_contactPointFlags |= flags;
    point->m_contactCFM = btScalar(200);
    point->m_contactERP = btScalar(0.3);
  });
}

std::vector<Feature> ModeFeatures() {
  constexpr int kTwoDirections = SOLVER_USE_2_FRICTION_DIRECTIONS, kWarm = SOLVER_USE_WARMSTARTING;
  constexpr int kCached = SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
  constexpr int kFixedDirections = SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION;
  return {
      Mode("DefaultMode", 0, 0),
      Mode("OneDirection", 0, kTwoDirections),
      Mode("NoWarmStart", 0, kWarm),
      Mode("FixedDirections", kFixedDirections, 0),
      Mode("OneFixedDirection", kFixedDirections, kTwoDirections),
      Mode("CachedDirections", kCached | kFixedDirections, 0),
      Mode("EveryOtherFlag",
           SOLVER_RANDMIZE_ORDER | SOLVER_INTERLEAVE_CONTACT_AND_FRICTION_CONSTRAINTS, SOLVER_SIMD),
  };
}

std::vector<Feature> InfoFeatures() {
  return {
      Info("NoSplitImpulse", [](btContactSolverInfo* info) { info->m_splitImpulse = 0; }),
      Info("AlwaysSplitImpulse",
           [](btContactSolverInfo* info) { info->m_splitImpulsePenetrationThreshold = 0; }),
      Info("OverRelaxation", [](btContactSolverInfo* info) { info->m_sor = btScalar(1.3); }),
      Info("GlobalSoftness", [](btContactSolverInfo* info) { info->m_globalCfm = btScalar(1e-3); }),
      Info("Erp2", [](btContactSolverInfo* info) { info->m_erp2 = btScalar(0.7); }),
      Info("Slop", [](btContactSolverInfo* info) { info->m_linearSlop = btScalar(0.02); }),
      Info("WarmStartFactor",
           [](btContactSolverInfo* info) { info->m_warmstartingFactor = btScalar(0.5); }),
      Info("RestitutionThreshold",
           [](btContactSolverInfo* info) { info->m_restitutionVelocityThreshold = 2; }),
  };
}

std::vector<Feature> BodyFeatures() {
  return {
      EachBody("AnisotropicFriction",
               [](btRigidBody* body) {
                 body->setAnisotropicFriction({1, btScalar(0.2), btScalar(0.5)},
                                              btCollisionObject::CF_ANISOTROPIC_FRICTION);
               }),
      EachBody("AnisotropicRollingFriction",
               [](btRigidBody* body) {
                 body->setAnisotropicFriction({1, 0, btScalar(0.5)},
                                              btCollisionObject::CF_ANISOTROPIC_ROLLING_FRICTION);
               }),
      EachBody("NoGyroscopicTerm", [](btRigidBody* body) { body->setFlags(0); }),
      EachBody("ExplicitGyroscopicTerm",
               [](btRigidBody* body) { body->setFlags(BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT); }),
      EachBody(
          "GyroscopicTermInTheWorld",
          [](btRigidBody* body) { body->setFlags(BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD); }),
      EachBody("LockedAxes",
               [](btRigidBody* body) {
                 body->setLinearFactor({1, 1, 0});
                 body->setAngularFactor({0, 0, 1});
               }),
      EachBody("ThickProcessingThreshold",
               [](btRigidBody* body) { body->setContactProcessingThreshold(btScalar(-0.001)); }),
  };
}

std::vector<Feature> PointFeatures() {
  constexpr int kCached = SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
  return {
      FlaggedPoints("ContactCfm", BT_CONTACT_FLAG_HAS_CONTACT_CFM),
      FlaggedPoints("ContactErp", BT_CONTACT_FLAG_HAS_CONTACT_ERP),
      FlaggedPoints("ContactStiffness", BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING),
      FlaggedPoints("FrictionAnchor", BT_CONTACT_FLAG_FRICTION_ANCHOR),
      EachPoint("DirectionsOfUsers", kCached,
                [](btManifoldPoint* point) {
                  point->m_contactPointFlags |= BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
                  btPlaneSpace1(point->m_normalWorldOnB, point->m_lateralFrictionDir2,
                                point->m_lateralFrictionDir1);
                  point->m_contactMotion1 = btScalar(1.5);
                  point->m_contactMotion2 = btScalar(-0.5);
                  point->m_frictionCFM = btScalar(0.01);
                }),
  };
}

class RowsWith : public testing::TestWithParam<Feature> {};

TEST_P(RowsWith, AreBullets) {
  const RowCounts counts = ExpectBulletsRowsInWorld(GetParam().build, GetParam().change, 120, 3);
  EXPECT_GT(counts.normals, 50);
  EXPECT_GT(counts.frictions, 50);
  EXPECT_GT(counts.twists, 30);
}

INSTANTIATE_TEST_SUITE_P(Mode, RowsWith, testing::ValuesIn(ModeFeatures()), NameOfCase());
INSTANTIATE_TEST_SUITE_P(Info, RowsWith, testing::ValuesIn(InfoFeatures()), NameOfCase());
INSTANTIATE_TEST_SUITE_P(Body, RowsWith, testing::ValuesIn(BodyFeatures()), NameOfCase());
INSTANTIATE_TEST_SUITE_P(Point, RowsWith, testing::ValuesIn(PointFeatures()), NameOfCase());

TEST(Rows, AreBulletsOnAMovingTable) {
  const RowCounts counts = ExpectBulletsRowsInWorld(
      [](World* world) {
        btRigidBody* const table =
            world->AddBox(btVector3(2, btScalar(0.5), 2), {.pose = At(0, 0, 0)});
        table->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
        table->setActivationState(DISABLE_DEACTIVATION);
        // Bullet takes the velocity of a kinematic body from where it has been
        table->setInterpolationWorldTransform(At(btScalar(-0.01), 0, btScalar(0.02)));
        table->setLinearVelocity({btScalar(0.6), 0, 1});
        table->setAngularVelocity({0, 2, 0});
        world->AddBox(btVector3(1, 1, 1) / 2, {.mass = 2, .pose = At(0, btScalar(0.99), 0)});
      },
      AsItIs, 30, 1);
  EXPECT_GT(counts.normals, 0);
}

}  // namespace
}  // namespace cairn::test
