// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace cairn::test {

/// Boxes, balls that are swept and roll, bars of two boxes each, chains and a moving floor, in a
/// world of somebody else's: everything that has an order in Bullet. For a second it also has a box
/// whose friction is anisotropic.
class Pile {
 public:
  /// @param side  of the square of bodies that a layer is
  explicit Pile(btDiscreteDynamicsWorld* world, int side = 6);
  ~Pile();
  Pile(const Pile&) = delete;
  Pile& operator=(const Pile&) = delete;

  void Step(int frames);
  /// Of where all bodies are and how they move.
  std::uint64_t Hash() const;

 private:
  btRigidBody* Add(btScalar mass, btCollisionShape* shape, const btVector3& at);
  void AddLayer(int layer, int side);
  void AddChain(const btVector3& at);

  btDiscreteDynamicsWorld& world_;
  btStaticPlaneShape ground_{btVector3(0, 1, 0), 0};
  btBoxShape box_{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
  btBoxShape floor_{btVector3(3, btScalar(0.1), 3)};
  btSphereShape ball_{btScalar(0.3)};
  btCompoundShape bar_;
  btRigidBody* moving_floor_ = nullptr;
  btRigidBody* uneven_ = nullptr;
  int frame_ = 0;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
};

}  // namespace cairn::test
