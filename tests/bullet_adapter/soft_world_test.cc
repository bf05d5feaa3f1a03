// SPDX-License-Identifier: MIT
// btSoftRigidDynamicsWorld: soft bodies and ghosts are among the bodies that the solver is handed.
#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "tests/bullet_adapter/any_world.h"
#include "tests/bullet_adapter/watched_solver.h"

namespace cairn::test {
namespace {

/// A cloth that falls over a tower, a rope with a box at its end, a ghost that they all go through.
class ClothWorld {
 public:
  explicit ClothWorld(btConstraintSolver* solver) {
    auto configuration = std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>();
    auto dispatcher = std::make_unique<btCollisionDispatcher>(configuration.get());
    world_ = std::make_unique<AnyWorld>(
        std::move(configuration), std::move(dispatcher), [solver](const AnyWorld::Parts& parts) {
          return std::make_unique<btSoftRigidDynamicsWorld>(parts.dispatcher, parts.broadphase,
                                                            solver, parts.configuration);
        });
    world_->AddGround();
    world_->AddTower(3, 0, 0);
    btSoftBodyWorldInfo& info = soft().getWorldInfo();
    info.m_gravity = {0, btScalar(-9.81), 0};
    info.m_dispatcher = &world_->dispatcher();
    info.m_broadphase = &world_->broadphase();
    info.m_sparsesdf.Initialize();
    AddCloth(&info);
    AddRope(&info);
    AddGhost();
  }
  ~ClothWorld() {
    soft().removeCollisionObject(&ghost_);
    soft().removeSoftBody(cloth_.get());
    soft().removeSoftBody(rope_.get());
  }

  AnyWorld& world() { return *world_; }
  const btSoftBody& cloth() const { return *cloth_; }
  const btSoftBody& rope() const { return *rope_; }
  const btRigidBody& weight() const { return *weight_; }

 private:
  btSoftRigidDynamicsWorld& soft() {
    return static_cast<btSoftRigidDynamicsWorld&>(world_->bullet());
  }

  void AddCloth(btSoftBodyWorldInfo* info) {
    cloth_.reset(btSoftBodyHelpers::CreatePatch(*info, {-1, 4, -1}, {1, 4, -1}, {-1, 4, 1},
                                                {1, 4, 1}, 9, 9, 0, true));
    cloth_->setTotalMass(btScalar(0.2));
    soft().addSoftBody(cloth_.get());
  }

  void AddRope(btSoftBodyWorldInfo* info) {
    rope_.reset(btSoftBodyHelpers::CreateRope(*info, {6, 5, 0}, {6, 3, 0}, 8, 1));
    rope_->m_cfg.piterations = 20;
    rope_->setTotalMass(1);
    soft().addSoftBody(rope_.get());
    weight_ = world_->AddBox({btScalar(0.2), btScalar(0.2), btScalar(0.2)}, 1,
                             btTransform(btQuaternion::getIdentity(), {6, btScalar(2.8), 0}));
    rope_->appendAnchor(rope_->m_nodes.size() - 1, weight_);
  }

  void AddGhost() {
    ghost_shape_ = std::make_unique<btBoxShape>(btVector3(2, 2, 2));
    ghost_.setCollisionShape(ghost_shape_.get());
    ghost_.setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);
    ghost_.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 2, 0)));
    soft().addCollisionObject(&ghost_);
  }

  std::unique_ptr<AnyWorld> world_;
  std::unique_ptr<btSoftBody> cloth_, rope_;
  btRigidBody* weight_ = nullptr;
  std::unique_ptr<btCollisionShape> ghost_shape_;
  btGhostObject ghost_;
};

bool AllFinite(const btSoftBody& body) {
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btVector3& at = body.m_nodes[i].m_x;
    if (!std::isfinite(at.x()) || !std::isfinite(at.y()) || !std::isfinite(at.z())) return false;
  }
  return true;
}

btScalar Lowest(const btSoftBody& body) {
  btScalar lowest = BT_LARGE_FLOAT;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    lowest = btMin(lowest, body.m_nodes[i].m_x.y());
  }
  return lowest;
}

TEST(SoftWorlds, CarryClothRopesAndGhostsAmongRigidBodies) {
  WatchedSolver solver;
  ClothWorld cloths(&solver);
  cloths.world().Step(240);
  EXPECT_EQ(solver.fallbacks, 0);
  EXPECT_GT(solver.prepared, 200);
  EXPECT_TRUE(AllFinite(cloths.cloth()));
  EXPECT_TRUE(AllFinite(cloths.rope()));
  // the tower stands under the cloth, a centre each metre
  for (int i = 1; i <= 3; ++i) {
    const btVector3& at = cloths.world().bodies()[i]->getWorldTransform().getOrigin();
    EXPECT_NEAR(at.y(), i - 0.5, 0.05) << i;
    EXPECT_LT(std::hypot(at.x(), at.z()), 0.1) << i;
  }
  EXPECT_GT(Lowest(cloths.cloth()), -0.2);
  // 2 m of rope from 5 m, that stretches
  EXPECT_GT(cloths.weight().getWorldTransform().getOrigin().y(), 1);
  EXPECT_LT(cloths.weight().getWorldTransform().getOrigin().y(), 3);
}

TEST(SoftWorlds, AreMovedAsByBullet) {
  btSequentialImpulseConstraintSolver bullets;
  WatchedSolver ours({.k_sm = 0});
  ClothWorld expected(&bullets), actual(&ours);
  // while the cloth falls and the weight swings: then it is chance where the cloth slides to
  expected.world().Step(30);
  actual.world().Step(30);
  const auto& nodes = expected.cloth().m_nodes;
  for (int i = 0; i < nodes.size(); ++i) {
    EXPECT_LT((nodes[i].m_x - actual.cloth().m_nodes[i].m_x).length(), 0.1) << i;
  }
  EXPECT_LT((expected.weight().getWorldTransform().getOrigin() -
             actual.weight().getWorldTransform().getOrigin())
                .length(),
            0.02);
}

}  // namespace
}  // namespace cairn::test
