// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>
#include <unordered_map>
#include <vector>

namespace cairn::bench {

/// What a world hands its solver in one substep, kept so that several solvers can be given the very
/// same state one after the other.
class Substep {
 public:
  struct Group {
    std::vector<btCollisionObject*> bodies;
    std::vector<btPersistentManifold*> manifolds;
    std::vector<btTypedConstraint*> joints;
  };

  void Begin(int num_bodies, int num_manifolds);
  void Add(Group group, btDispatcher* dispatcher);

  /// Remembers everything a solver may write: velocities, transforms, impulses of contact points
  /// and joints, joints that break.
  void Capture();
  /// Brings it back.
  void Restore() const;

  /// Hands the groups to a solver as the world would.
  void SolveWith(btConstraintSolver* solver, const btContactSolverInfo& info,
                 btIDebugDraw* debug_drawer) const;

  /// Impulses as they stand in the objects: of every contact point (normal, two lateral), then of
  /// every joint, group by group.
  std::vector<double> Impulses() const;

  const std::vector<Group>& groups() const { return groups_; }
  /// Every rigid body a solver may change, in the order of the groups, each once.
  const std::vector<btRigidBody*>& bodies() const { return bodies_; }

 private:
  struct BodyState {
    btTransform transform;
    btVector3 linear, angular;
  };
  struct JointState {
    bool enabled;
    btScalar applied_impulse;
    btJointFeedback feedback;
  };

  void CollectBodies();

  int num_bodies_ = 0, num_manifolds_ = 0;
  btDispatcher* dispatcher_ = nullptr;
  std::vector<Group> groups_;
  std::vector<btRigidBody*> bodies_;
  std::vector<BodyState> body_states_;
  std::vector<btManifoldPoint> points_;  ///< of all manifolds of all groups, in order
  std::vector<JointState> joint_states_;
};

/// For a solver that is given the substeps of a world which another one drives: the impulses that
/// it left in the joints itself. cairn::bullet::ConstraintSolver knows those of a joint again by
/// the one that the joint keeps, which the other solver overwrites; Bullet starts joints from zero.
class JointImpulses {
 public:
  /// Before a solve: brings back what was kept.
  void Put(const Substep& substep) const;
  /// After it.
  void Keep(const Substep& substep);

 private:
  std::unordered_map<const btTypedConstraint*, btScalar> impulses_;
};

}  // namespace cairn::bench
