// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace cairn::test {

/// A world of any of Bullet's classes, with its bodies and joints. Gravity is -9.81 m/s^2 along y.
class AnyWorld {
 public:
  struct Parts {
    btDispatcher* dispatcher;
    btBroadphaseInterface* broadphase;
    btCollisionConfiguration* configuration;
  };
  using Make = std::function<std::unique_ptr<btDynamicsWorld>(const Parts&)>;

  AnyWorld(std::unique_ptr<btCollisionConfiguration> configuration,
           std::unique_ptr<btCollisionDispatcher> dispatcher, const Make& make);
  AnyWorld(const AnyWorld&) = delete;
  AnyWorld& operator=(const AnyWorld&) = delete;
  ~AnyWorld();

  /// Half extents [m]; mass 0 [kg] makes it static.
  btRigidBody* AddBox(const btVector3& half_extents, btScalar mass, const btTransform& pose);
  void AddGround();
  /// Boxes on each other with gaps of 1 cm, at (x, z).
  void AddTower(int height, btScalar x, btScalar z);
  /// Boxes on pins below each other, the first one hung from the world.
  void AddChain(int length, btScalar x, btScalar z);

  /// Adds it, and keeps it. @param collide  whether its bodies do
  void AddJoint(std::unique_ptr<btTypedConstraint> joint, bool collide = true);

  void Step(int frames);

  btDynamicsWorld& bullet() { return *world_; }
  btCollisionDispatcher& dispatcher() { return *dispatcher_; }
  btDbvtBroadphase& broadphase() { return broadphase_; }
  const std::vector<btRigidBody*>& bodies() const { return pointers_; }
  const std::vector<std::unique_ptr<btTypedConstraint>>& joints() const { return joints_; }
  /// Of poses and velocities of all bodies.
  std::uint64_t Hash() const;
  /// Of bodies that are not static [m/s].
  double LargestSpeed() const;

 private:
  std::unique_ptr<btCollisionConfiguration> configuration_;
  std::unique_ptr<btCollisionDispatcher> dispatcher_;
  btDbvtBroadphase broadphase_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<btRigidBody*> pointers_;
  std::unique_ptr<btDynamicsWorld> world_;
};

/// The world that most programs use.
std::unique_ptr<AnyWorld> DiscreteWorld(btConstraintSolver* solver);

}  // namespace cairn::test
