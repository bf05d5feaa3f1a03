// SPDX-License-Identifier: MIT
#include "animation/animation.h"

#include <algorithm>
#include <cmath>

#include "animation/animated_shape.h"
#include "scenes/facts.h"

namespace cairn::cli {
namespace {

Pose ToPose(const btTransform& transform) {
  const btVector3& p = transform.getOrigin();
  const btQuaternion q = transform.getRotation();
  return {.position = {float(p.x()), float(p.y()), float(p.z())},
          .rotation = {float(q.x()), float(q.y()), float(q.z()), float(q.w())}};
}

}  // namespace

int AnimationRecorder::ShapeOf(const btCollisionShape& shape) {
  const auto [entry, is_new] = shapes_.try_emplace(&shape, int(animation_.shapes.size()));
  if (is_new) animation_.shapes.push_back(ToAnimatedShape(shape));
  return entry->second;
}

void AnimationRecorder::AddParts(const btCollisionShape& shape, const btTransform& pose,
                                 AnimatedBody* body) {
  if (!shape.isCompound()) {
    body->parts.push_back({.shape = ShapeOf(shape), .pose = ToPose(pose * AxisOf(shape))});
    return;
  }
  const auto& compound = static_cast<const btCompoundShape&>(shape);
  for (int i = 0; i < compound.getNumChildShapes(); ++i) {
    AddParts(*compound.getChildShape(i), pose * compound.getChildTransform(i), body);
  }
}

AnimatedBody AnimationRecorder::Describe(const btCollisionShape& shape) {
  AnimatedBody body;
  AddParts(shape, btTransform::getIdentity(), &body);
  return body;
}

void AnimationRecorder::AddNewBodies(const bench::World& world) {
  if (animation_.frames.empty()) {
    const btVector3 gravity = world.bullet()->getGravity();
    if (!gravity.fuzzyZero()) {
      const btVector3 up = -gravity.normalized();
      animation_.up = {float(up.x()), float(up.y()), float(up.z())};
    }
    const btCollisionObjectArray& objects = world.bullet()->getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
      if (!objects[i]->isStaticOrKinematicObject()) continue;
      animation_.still_bodies.push_back(Describe(*objects[i]->getCollisionShape()));
      animation_.still_poses.push_back(ToPose(objects[i]->getWorldTransform()));
    }
  }
  for (size_t i = animation_.bodies.size(); i < world.dynamic_bodies().size(); ++i) {
    const btRigidBody* const body = world.dynamic_bodies()[i];
    index_[body] = static_cast<int>(i);
    animation_.bodies.push_back(Describe(*body->getCollisionShape()));
  }
}

std::vector<float> AnimationRecorder::Errors(const bench::World& world) const {
  std::vector<float> errors(world.dynamic_bodies().size(), 0);
  const auto raise = [&](const btCollisionObject* body, double error) {
    const auto entry = index_.find(body);
    if (entry == index_.end() || !(error > errors[entry->second])) return;
    errors[entry->second] = static_cast<float>(error);
  };
  btDispatcher* const dispatcher = const_cast<btDispatcher*>(world.bullet()->getDispatcher());
  for (int m = 0; m < dispatcher->getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher->getManifoldByIndexInternal(m);
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      const double depth = -manifold.getContactPoint(i).getDistance();
      raise(manifold.getBody0(), depth);
      raise(manifold.getBody1(), depth);
    }
  }
  for (const btTypedConstraint* joint : world.joints()) {
    const double gap = bench::JointGap(*joint);
    if (std::isnan(gap)) continue;
    raise(&joint->getRigidBodyA(), gap);
    raise(&joint->getRigidBodyB(), gap);
  }
  return errors;
}

void AnimationRecorder::Take(const bench::World& world) {
  AddNewBodies(world);
  AnimationFrame& frame = animation_.frames.emplace_back();
  frame.poses.reserve(world.dynamic_bodies().size());
  for (const btRigidBody* body : world.dynamic_bodies()) {
    frame.poses.push_back(ToPose(body->getCenterOfMassTransform()));
  }
  frame.errors = Errors(world);
}

}  // namespace cairn::cli
