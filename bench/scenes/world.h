// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace cairn::bench {

/// What a body is made of, as Bullet counts it. Where two bodies touch, their frictions are
/// multiplied: 0.5 on 0.5 slides like 0.25.
struct Surface {
  btScalar friction = btScalar(0.5);
  btScalar rolling_friction = 0;   ///< More than 0 adds rows that resist rolling.
  btScalar spinning_friction = 0;  ///< Only counts together with rolling friction.
  btScalar restitution = 0;        ///< Multiplied likewise.
};

/// Whether two bodies that a joint connects also touch each other.
enum class ConnectedBodies { kCollide, kPassThrough };

/// A Bullet world that owns all of its parts but the solver. Units are m, kg, s; y points up and
/// gravity is -9.81 m/s^2; nothing bounces unless its surface says so.
///
/// Bodies never sleep unless LetSleep() says so: a scene that has come to rest is what a solver is
/// measured on, and Bullet does not solve what sleeps. Two friction directions per contact,
/// otherwise Bullet's default settings; they may be changed in solver_info().
///
/// The same calls give the same bits each time, whatever else the process does.
class World {
 public:
  /// A body that is placed: mass 0 [kg] makes it static.
  struct Placing {
    btScalar mass = 0;
    btTransform pose = btTransform::getIdentity();  ///< of the centre of mass
    Surface surface = {};
  };

  /// @pre `solver` outlives the world; `time_step` > 0 [s].
  explicit World(btConstraintSolver* solver, btScalar time_step = btScalar(1) / 60);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Advances by exactly one time step, in so many equal parts.
  void Step(int parts = 1);
  /// Of the steps from now on, > 0 [s].
  void SetTimeStep(btScalar time_step) { time_step_ = time_step; }
  /// 1, as Bullet's default, or 2, as here: whether SOLVER_USE_2_FRICTION_DIRECTIONS is set.
  void SetFrictionDirections(int directions);
  /// Bodies, those that are there and those that come, may fall asleep as Bullet's defaults say.
  void LetSleep();

  /// Half extents [m].
  btRigidBody* AddBox(const btVector3& half_extents, const Placing& placing);
  /// Radius [m].
  btRigidBody* AddSphere(btScalar radius, const Placing& placing);
  /// Axis along y; radius and height [m].
  btRigidBody* AddCylinder(btScalar radius, btScalar height, const Placing& placing);
  /// Axis along y; radius and distance of the two centres [m].
  btRigidBody* AddCapsule(btScalar radius, btScalar length, const Placing& placing);
  /// Corners relative to the centre of mass [m]; Bullet adds its collision margin outside of them.
  btRigidBody* AddConvexHull(std::span<const btVector3> corners, const Placing& placing);

  /// A static square box with its top at y = 0, reaching `half_side` [m] from the origin.
  btRigidBody* AddGround(btScalar half_side);
  /// Ground and four static walls around a square, `half_side` and `wall_height` [m].
  void AddPit(btScalar half_side, btScalar wall_height);

  btTypedConstraint* AddJoint(std::unique_ptr<btTypedConstraint> joint, ConnectedBodies connected);

  /// Takes a joint, or a body with its joints, out of the world. They stay valid, and the world's.
  void Remove(btTypedConstraint* joint);
  void Remove(btRigidBody* body);

  /// Takes bodies and joints that somebody else put into bullet() among those below. They stay with
  /// their owner, who takes them out in `release`, called before the world goes.
  void Adopt(std::function<void()> release);

  /// Bodies with mass, and joints, each in the order in which they were added.
  std::span<btRigidBody* const> dynamic_bodies() const { return dynamic_bodies_; }
  std::span<btTypedConstraint* const> joints() const { return joint_pointers_; }

  btDiscreteDynamicsWorld* bullet() { return dynamics_.get(); }
  const btDiscreteDynamicsWorld* bullet() const { return dynamics_.get(); }
  btContactSolverInfo& solver_info() { return dynamics_->getSolverInfo(); }
  btScalar time_step() const { return time_step_; }

 private:
  /// A kind of shape and its sizes. Equal keys share one shape.
  using ShapeKey = std::vector<btScalar>;

  template <class MakeShape>
  btCollisionShape* Share(ShapeKey key, MakeShape make);
  btRigidBody* Add(btCollisionShape* shape, const Placing& placing);

  btScalar time_step_;
  bool may_sleep_ = false;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  std::map<ShapeKey, std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<btRigidBody*> dynamic_bodies_;
  std::vector<btTypedConstraint*> joint_pointers_;
  std::unique_ptr<btDiscreteDynamicsWorld> dynamics_;
  std::vector<std::function<void()>> releases_;
};

/// From now on a static body goes where its pose is set, from step to step, and pushes others.
void MakeKinematic(btRigidBody* body);

/// No rotation, at (x, y, z) [m].
inline btTransform At(btScalar x, btScalar y, btScalar z) {
  return btTransform(btQuaternion::getIdentity(), btVector3(x, y, z));
}

}  // namespace cairn::bench
