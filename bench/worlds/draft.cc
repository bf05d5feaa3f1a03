// SPDX-License-Identifier: MIT
#include "worlds/draft.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cairn::bench {

btScalar Draft::DrawRatio(double low, double high) {
  return btScalar(std::exp(random_.Within(std::log(low), std::log(high))));
}

btScalar Draft::Load(btScalar mass) {
  if (loads_ == Loads::kAsDrawn) return mass;
  return mass * btScalar(std::exp(load_random_.Within(std::log(10.0), std::log(1e4))));
}

int Draft::Count(int least, int most) {
  const double drawn = random_.Within(least, most + 1);
  return std::clamp(static_cast<int>(drawn * scale_), least, most);
}

btRigidBody* Draft::Box(const btVector3& half, btScalar mass, const btTransform& pose) {
  return world_->AddBox(half, Place(mass, pose));
}

btRigidBody* Draft::Sphere(btScalar radius, btScalar mass, const btVector3& at) {
  return world_->AddSphere(radius, Place(mass, bench::At(at.x(), at.y(), at.z())));
}

btRigidBody* Draft::Capsule(btScalar radius, btScalar length, btScalar mass,
                            const btTransform& pose) {
  return world_->AddCapsule(radius, length, Place(mass, pose));
}

btRigidBody* Draft::Cylinder(btScalar radius, btScalar height, btScalar mass,
                             const btTransform& pose) {
  return world_->AddCylinder(radius, height, Place(mass, pose));
}

btRigidBody* Draft::Hull(btScalar radius, btScalar mass, const btTransform& pose) {
  // A corner near each of a cube's, so that no hull is flat.
  std::array<btVector3, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const btVector3 way(btScalar(i & 1 ? 1 : -1), btScalar(i & 2 ? 1 : -1),
                        btScalar(i & 4 ? 1 : -1));
    const btScalar reach = radius * Draw(0.75, 0.95);
    corners[i] = way.normalized() * reach + random_.InCube(0.05 * radius);
  }
  return world_->AddConvexHull(corners, Place(mass, pose));
}

btRigidBody* Draft::Thing(btScalar radius, btScalar mass, const btVector3& at) {
  btTransform pose = bench::At(at.x(), at.y(), at.z());
  const btScalar turn = Draw(-0.3, 0.3);
  pose.setRotation(btQuaternion(btVector3(0, 0, 1), turn));
  switch (Choose(4)) {
    case 0:
      return Box(btVector3(1, 1, 1) * radius * btScalar(0.55), mass, pose);
    case 1:
      return Hull(radius * btScalar(0.9), mass, pose);
    case 2:
      return Capsule(radius * btScalar(0.4), radius, mass, pose);
    default:
      return Sphere(radius * btScalar(0.9), mass, at);
  }
}

void Draft::Ground() {
  constexpr btScalar kHalf = 60, kThickness = 1;
  Box(btVector3(kHalf, kThickness, kHalf), 0, bench::At(0, -kThickness, 0));
}

}  // namespace cairn::bench
