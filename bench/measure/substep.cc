// SPDX-License-Identifier: MIT
#include "measure/substep.h"

#include <unordered_set>
#include <utility>

namespace cairn::bench {

void Substep::Begin(int num_bodies, int num_manifolds) {
  num_bodies_ = num_bodies;
  num_manifolds_ = num_manifolds;
  groups_.clear();
}

void Substep::Add(Group group, btDispatcher* dispatcher) {
  groups_.push_back(std::move(group));
  dispatcher_ = dispatcher;
}

void Substep::CollectBodies() {
  bodies_.clear();
  std::unordered_set<const btRigidBody*> seen;
  const auto add = [&](btCollisionObject* object) {
    btRigidBody* const body = btRigidBody::upcast(object);
    if (body != nullptr && !body->isStaticObject() && seen.insert(body).second) {
      bodies_.push_back(body);
    }
  };
  for (const Group& group : groups_) {
    for (btCollisionObject* object : group.bodies) add(object);
    for (const btPersistentManifold* manifold : group.manifolds) {
      add(const_cast<btCollisionObject*>(manifold->getBody0()));
      add(const_cast<btCollisionObject*>(manifold->getBody1()));
    }
    for (btTypedConstraint* joint : group.joints) {
      add(&joint->getRigidBodyA());
      add(&joint->getRigidBodyB());
    }
  }
}

void Substep::Capture() {
  CollectBodies();
  body_states_.clear();
  points_.clear();
  joint_states_.clear();
  for (const btRigidBody* body : bodies_) {
    body_states_.push_back(
        {body->getWorldTransform(), body->getLinearVelocity(), body->getAngularVelocity()});
  }
  for (const Group& group : groups_) {
    for (btPersistentManifold* manifold : group.manifolds) {
      for (int i = 0; i < manifold->getNumContacts(); ++i) {
        points_.push_back(manifold->getContactPoint(i));
      }
    }
    for (btTypedConstraint* joint : group.joints) {
      const btJointFeedback* feedback = joint->getJointFeedback();
      joint_states_.push_back({joint->isEnabled(), joint->internalGetAppliedImpulse(),
                               feedback != nullptr ? *feedback : btJointFeedback{}});
    }
  }
}

void Substep::Restore() const {
  for (size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i]->setWorldTransform(body_states_[i].transform);
    bodies_[i]->setLinearVelocity(body_states_[i].linear);
    bodies_[i]->setAngularVelocity(body_states_[i].angular);
  }
  auto point = points_.begin();
  auto joint_state = joint_states_.begin();
  for (const Group& group : groups_) {
    for (btPersistentManifold* manifold : group.manifolds) {
      for (int i = 0; i < manifold->getNumContacts(); ++i) manifold->getContactPoint(i) = *point++;
    }
    for (btTypedConstraint* joint : group.joints) {
      joint->setEnabled(joint_state->enabled);
      joint->internalSetAppliedImpulse(joint_state->applied_impulse);
      if (joint->getJointFeedback() != nullptr) *joint->getJointFeedback() = joint_state->feedback;
      ++joint_state;
    }
  }
}

std::vector<double> Substep::Impulses() const {
  std::vector<double> impulses;
  for (const Group& group : groups_) {
    for (const btPersistentManifold* manifold : group.manifolds) {
      for (int i = 0; i < manifold->getNumContacts(); ++i) {
        const btManifoldPoint& point = manifold->getContactPoint(i);
        impulses.insert(impulses.end(), {point.m_appliedImpulse, point.m_appliedImpulseLateral1,
                                         point.m_appliedImpulseLateral2});
      }
    }
    for (btTypedConstraint* joint : group.joints) {
      impulses.push_back(joint->internalGetAppliedImpulse());
    }
  }
  return impulses;
}

void Substep::SolveWith(btConstraintSolver* solver, const btContactSolverInfo& info,
                        btIDebugDraw* debug_drawer) const {
  solver->prepareSolve(num_bodies_, num_manifolds_);
  for (Group group : groups_) {
    solver->solveGroup(group.bodies.data(), static_cast<int>(group.bodies.size()),
                       group.manifolds.data(), static_cast<int>(group.manifolds.size()),
                       group.joints.data(), static_cast<int>(group.joints.size()), info,
                       debug_drawer, dispatcher_);
  }
  solver->allSolved(info, debug_drawer);
}

void JointImpulses::Put(const Substep& substep) const {
  for (const Substep::Group& group : substep.groups()) {
    for (btTypedConstraint* joint : group.joints) {
      const auto left = impulses_.find(joint);
      if (left != impulses_.end()) joint->internalSetAppliedImpulse(left->second);
    }
  }
}

void JointImpulses::Keep(const Substep& substep) {
  impulses_.clear();
  for (const Substep::Group& group : substep.groups()) {
    for (btTypedConstraint* joint : group.joints) {
      impulses_[joint] = joint->internalGetAppliedImpulse();
    }
  }
}

}  // namespace cairn::bench
