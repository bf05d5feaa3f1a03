// SPDX-License-Identifier: MIT
// A Bullet world on all cores: collision detection, islands and motion by Bullet's own Mt classes,
// contacts and joints by Cairn, all on the same threads. Needs a Bullet that locks
// (cmake/build-bullet-mt.sh); in any other one it says so, and does the same on one thread.
#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <btBulletDynamicsCommon.h>
#include <cairn/bullet/constraint_solver_pool.h>
#include <cairn/bullet/task_scheduler.h>

#include <cstdio>
#include <memory>
#include <vector>

namespace {

constexpr int kTowers = 12;  // on a side
constexpr int kBoxes = 10;   // of a tower

std::unique_ptr<btRigidBody> MakeBody(btScalar mass, btCollisionShape* shape, const btVector3& at) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape->calculateLocalInertia(mass, inertia);
  auto body = std::make_unique<btRigidBody>(mass, nullptr, shape, inertia);
  body->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
  return body;
}

}  // namespace

int main() {
  btDefaultCollisionConfiguration configuration;
  cairn::bullet::TaskScheduler scheduler;
  if (!scheduler.complaint().empty()) std::printf("%s\n", scheduler.complaint().c_str());
  btSetTaskScheduler(&scheduler);
  btCollisionDispatcherMt dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  cairn::bullet::ConstraintSolverPool solver({.threads = scheduler.threads()});
  btDiscreteDynamicsWorldMt world(&dispatcher, &broadphase, &solver, nullptr, &configuration);
  world.setGravity(btVector3(0, btScalar(-9.81), 0));

  btStaticPlaneShape ground_shape(btVector3(0, 1, 0), 0);
  btBoxShape box_shape(btVector3(1, 1, 1) / 2);
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  bodies.push_back(MakeBody(0, &ground_shape, btVector3(0, 0, 0)));
  for (int i = 0; i < kTowers * kTowers * kBoxes; ++i) {
    const int tower = i / kBoxes;
    const btVector3 at(btScalar(2 * (tower % kTowers)), btScalar(i % kBoxes) + btScalar(0.5),
                       btScalar(2 * (tower / kTowers)));
    bodies.push_back(MakeBody(1, &box_shape, at));
  }
  for (const auto& body : bodies) world.addRigidBody(body.get());

  // all three arguments: this class of Bullet's has no defaults for them
  const btScalar step = btScalar(1) / 60;
  for (int frame = 0; frame < 60; ++frame) world.stepSimulation(step, 0, step);

  const btScalar top = bodies.back()->getWorldTransform().getOrigin().y() + btScalar(0.5);
  std::printf("%d towers on %d threads, the last one %.2f m high after 1 s\n", kTowers * kTowers,
              scheduler.threads(), static_cast<double>(top));

  for (const auto& body : bodies) world.removeRigidBody(body.get());
}
