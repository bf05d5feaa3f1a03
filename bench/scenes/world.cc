// SPDX-License-Identifier: MIT
#include "scenes/world.h"

#include <algorithm>
#include <utility>

namespace cairn::bench {
namespace {

constexpr btScalar kGravity = btScalar(-9.81);  // [m/s^2]
constexpr btScalar kGroundThickness = 2;        // [m], enough to push out what got far in
constexpr btScalar kPitWallThickness = 1;       // [m]

enum ShapeKind { kBox, kSphere, kCylinder, kCapsule, kConvexHull };

}  // namespace

World::World(btConstraintSolver* solver, btScalar time_step) : time_step_(time_step) {
  dynamics_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, solver,
                                                        &configuration_);
  dynamics_->setGravity(btVector3(0, kGravity, 0));
  SetFrictionDirections(2);
}

World::~World() {
  // A body must not know a joint any more when it dies. The rest the order of the members does.
  for (btTypedConstraint* joint : joint_pointers_) dynamics_->removeConstraint(joint);
  for (const auto& release : releases_) release();
}

void World::Step(int parts) {
  // 0 substeps: Bullet takes the time as one step instead of saving it up.
  for (int i = 0; i < parts; ++i) dynamics_->stepSimulation(time_step_ / btScalar(parts), 0);
}

void World::SetFrictionDirections(int directions) {
  int& mode = solver_info().m_solverMode;
  mode = directions == 2 ? mode | SOLVER_USE_2_FRICTION_DIRECTIONS
                         : mode & ~SOLVER_USE_2_FRICTION_DIRECTIONS;
}

void World::LetSleep() {
  may_sleep_ = true;
  for (btRigidBody* body : dynamic_bodies_) body->forceActivationState(ACTIVE_TAG);
}

template <class MakeShape>
btCollisionShape* World::Share(ShapeKey key, MakeShape make) {
  std::unique_ptr<btCollisionShape>& shape = shapes_[std::move(key)];
  if (!shape) shape = make();
  return shape.get();
}

btRigidBody* World::Add(btCollisionShape* shape, const Placing& placing) {
  btVector3 inertia(0, 0, 0);
  if (placing.mass > 0) shape->calculateLocalInertia(placing.mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(placing.mass, nullptr, shape, inertia);
  info.m_startWorldTransform = placing.pose;
  info.m_friction = placing.surface.friction;
  info.m_rollingFriction = placing.surface.rolling_friction;
  info.m_spinningFriction = placing.surface.spinning_friction;
  info.m_restitution = placing.surface.restitution;

  bodies_.push_back(std::make_unique<btRigidBody>(info));
  btRigidBody* const body = bodies_.back().get();
  if (placing.mass > 0) {
    if (!may_sleep_) body->setActivationState(DISABLE_DEACTIVATION);
    dynamic_bodies_.push_back(body);
  }
  dynamics_->addRigidBody(body);
  return body;
}

btRigidBody* World::AddBox(const btVector3& half_extents, const Placing& placing) {
  return Add(Share({kBox, half_extents.x(), half_extents.y(), half_extents.z()},
                   [&] { return std::make_unique<btBoxShape>(half_extents); }),
             placing);
}

btRigidBody* World::AddSphere(btScalar radius, const Placing& placing) {
  return Add(Share({kSphere, radius}, [&] { return std::make_unique<btSphereShape>(radius); }),
             placing);
}

btRigidBody* World::AddCylinder(btScalar radius, btScalar height, const Placing& placing) {
  const btVector3 half_extents(radius, height / 2, radius);
  return Add(Share({kCylinder, radius, height},
                   [&] { return std::make_unique<btCylinderShape>(half_extents); }),
             placing);
}

btRigidBody* World::AddCapsule(btScalar radius, btScalar length, const Placing& placing) {
  return Add(Share({kCapsule, radius, length},
                   [&] { return std::make_unique<btCapsuleShape>(radius, length); }),
             placing);
}

btRigidBody* World::AddConvexHull(std::span<const btVector3> corners, const Placing& placing) {
  ShapeKey key = {kConvexHull};
  for (const btVector3& corner : corners) {
    key.insert(key.end(), {corner.x(), corner.y(), corner.z()});
  }
  return Add(Share(std::move(key),
                   [&] {
                     auto hull = std::make_unique<btConvexHullShape>();
                     for (const btVector3& corner : corners) hull->addPoint(corner, false);
                     hull->recalcLocalAabb();
                     return hull;
                   }),
             placing);
}

btRigidBody* World::AddGround(btScalar half_side) {
  return AddBox(btVector3(half_side, kGroundThickness / 2, half_side),
                {.pose = At(0, -kGroundThickness / 2, 0)});
}

void World::AddPit(btScalar half_side, btScalar wall_height) {
  AddGround(half_side + kPitWallThickness);
  const btScalar middle = half_side + kPitWallThickness / 2, y = wall_height / 2;
  const btVector3 across_x(kPitWallThickness / 2, y, half_side + kPitWallThickness);
  const btVector3 across_z(half_side + kPitWallThickness, y, kPitWallThickness / 2);
  for (const btScalar side : {btScalar(-1), btScalar(1)}) {
    AddBox(across_x, {.pose = At(side * middle, y, 0)});
    AddBox(across_z, {.pose = At(0, y, side * middle)});
  }
}

void World::Remove(btTypedConstraint* joint) {
  if (std::erase(joint_pointers_, joint) != 0) dynamics_->removeConstraint(joint);
}

void World::Remove(btRigidBody* body) {
  const std::vector<btTypedConstraint*> joints = joint_pointers_;
  for (btTypedConstraint* joint : joints) {
    if (&joint->getRigidBodyA() == body || &joint->getRigidBodyB() == body) Remove(joint);
  }
  dynamics_->removeRigidBody(body);
  std::erase(dynamic_bodies_, body);
}

void World::Adopt(std::function<void()> release) {
  releases_.push_back(std::move(release));
  const auto add = [](auto* thing, auto* list) {
    if (std::find(list->begin(), list->end(), thing) == list->end()) list->push_back(thing);
  };
  const btAlignedObjectArray<btRigidBody*>& bodies = dynamics_->getNonStaticRigidBodies();
  for (int i = 0; i < bodies.size(); ++i) {
    if (bodies[i]->isStaticOrKinematicObject()) continue;
    bodies[i]->setActivationState(DISABLE_DEACTIVATION);
    add(bodies[i], &dynamic_bodies_);
  }
  for (int i = 0; i < dynamics_->getNumConstraints(); ++i) {
    add(dynamics_->getConstraint(i), &joint_pointers_);
  }
}

btTypedConstraint* World::AddJoint(std::unique_ptr<btTypedConstraint> joint,
                                   ConnectedBodies connected) {
  joints_.push_back(std::move(joint));
  joint_pointers_.push_back(joints_.back().get());
  dynamics_->addConstraint(joint_pointers_.back(), connected == ConnectedBodies::kPassThrough);
  return joint_pointers_.back();
}

void MakeKinematic(btRigidBody* body) {
  body->setCollisionFlags((body->getCollisionFlags() & ~btCollisionObject::CF_STATIC_OBJECT) |
                          btCollisionObject::CF_KINEMATIC_OBJECT);
  body->setActivationState(DISABLE_DEACTIVATION);
}

}  // namespace cairn::bench
