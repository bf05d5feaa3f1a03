// SPDX-License-Identifier: MIT
// A Bullet world solved by Cairn: a stack of ten boxes, and how high it is after two seconds.
#include <cairn/bullet/constraint_solver.h>

#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <memory>
#include <vector>

namespace {

constexpr int kBoxes = 10;
constexpr btScalar kSide = 1;  // [m]

std::unique_ptr<btRigidBody> MakeBody(btScalar mass, btCollisionShape* shape, btScalar height) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape->calculateLocalInertia(mass, inertia);
  auto body = std::make_unique<btRigidBody>(mass, nullptr, shape, inertia);
  body->setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, height, 0)));
  return body;
}

}  // namespace

int main() {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  // Before: btSequentialImpulseConstraintSolver solver;
  cairn::bullet::ConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(btVector3(0, btScalar(-9.81), 0));

  btStaticPlaneShape ground_shape(btVector3(0, 1, 0), 0);
  btBoxShape box_shape(btVector3(kSide, kSide, kSide) / 2);
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  bodies.push_back(MakeBody(0, &ground_shape, 0));
  for (int i = 0; i < kBoxes; ++i) {
    bodies.push_back(MakeBody(1, &box_shape, (btScalar(i) + btScalar(0.5)) * kSide));
  }
  for (const auto& body : bodies) world.addRigidBody(body.get());

  for (int frame = 0; frame < 120; ++frame) world.stepSimulation(btScalar(1) / 60, 0);

  const btScalar top = bodies.back()->getWorldTransform().getOrigin().y() + kSide / 2;
  std::printf("%d boxes, %.2f m high after 2 s; last frame: %d sweeps, residual %.0e m/s\n", kBoxes,
              double(top), solver.report().sweeps, solver.report().residual_max);

  for (const auto& body : bodies) world.removeRigidBody(body.get());
}
