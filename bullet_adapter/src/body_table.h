// SPDX-License-Identifier: MIT
#pragma once

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <atomic>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "body_names.h"
#include "cairn/bullet/precision.h"
#include "cairn/contact_problem.h"
#include "cairn/detail/prefetch.h"
#include "cairn/detail/stiffness.h"
#include "cairn/detail/threads.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// The body of a ContactProblem that stands for a rigid body, at rest: what is known of its motion
/// is in the targets of the rows. Kinematic and static bodies do not react, whatever mass they were
/// given. Without an id.
Body ToBody(const btRigidBody& rigid);
/// Whether impulses change the velocity of a body.
bool Reacts(const btRigidBody& rigid);

/// J M^-1 J' of one half of a row, without the factors of the body: what Bullet makes its step of.
btScalar HalfDiagonal(const btRigidBody& rigid, const btVector3& linear, const btVector3& angular);

/// How a body moves before any constraint acts on it.
struct Motion {
  btVector3 velocity, spin;  ///< Linear [m/s], angular [rad/s].
  /// What forces, torques and gyroscopic terms add over the step, likewise.
  btVector3 external_velocity, external_spin;
};

/// One of the two objects that a contact or a joint is between.
struct ContactEnd {
  btScalar at[3] = {0, 0, 0};                            ///< Where it is [m].
  int number = kWorld;                                   ///< In the BodyTable.
  bool reacts = false;                                   ///< Impulses move it.
  bool slides_unevenly = false, rolls_unevenly = false;  ///< Its friction is anisotropic.

  btVector3 origin() const { return {at[0], at[1], at[2]}; }
};

/// The bodies of a substep by number. A number belongs to each body that reacts, and to each
/// kinematic one for its velocity; everything else is kWorld. Bullet's companion ids are left
/// alone, and nothing is written to bodies that do not react: islands on other threads may share
/// them.
class BodyTable {
 public:
  /// Begins a substep with the bodies that Bullet lists; entries that are no rigid bodies are
  /// passed over.
  void Begin(std::span<btCollisionObject* const> objects, const btContactSolverInfo& info,
             detail::Threads* threads);
  /// Objects of the next substep are those of another world.
  void Forget();
  /// Does to the bodies that are there, those of enabled joints, what tension asks for where steps
  /// are that long [s].
  void Stiffen(std::span<btTypedConstraint* const> joints, btScalar part,
               GeometricStiffness* stiffness);

  /// An object. One that was not listed (kinematic, asleep, in no world) gets a number when it is
  /// first asked for. The reference is good until another object is asked for.
  const ContactEnd& EndOf(const btCollisionObject& object) {
    const int index = object.getWorldArrayIndex();
    if (index >= 0 && index < static_cast<int>(slots_.size())) {
      const Slot& slot = slots_[index];
      if (slot.substep == substep_ && slot.object == &object) return slot.end;
    }
    return Enter(object);
  }

  /// An object that was listed or asked for before, or nullptr. Any thread may ask, while none
  /// enters another one.
  const ContactEnd* Find(const btCollisionObject& object) const {
    const int index = object.getWorldArrayIndex();
    if (index >= 0 && index < static_cast<int>(slots_.size())) {
      const Slot& slot = slots_[index];
      if (slot.substep == substep_ && slot.object == &object) return &slot.end;
    }
    if (strangers_.empty()) return nullptr;
    const auto stranger = strangers_.find(&object);
    const bool is_known = stranger != strangers_.end() && stranger->second.substep == substep_;
    return is_known ? &stranger->second.end : nullptr;
  }
  /// How often ends have moved to another place: pointers to them are good until they do.
  int growths() const { return growths_; }

  int size() const { return static_cast<int>(bodies_.size()); }
  std::span<const Body> bodies() const { return bodies_; }
  const Motion& motion(int number) const { return motions_[number]; }
  btRigidBody& rigid(int number) const { return *rigids_[number]; }
  /// Before the velocity of a body is written.
  void PrefetchVelocity(int number) const {
    Prefetch(&rigids_[number]->getLinearVelocity(), 2 * sizeof(btVector3));
  }
  /// Whether impulses move it; not so for kWorld.
  bool reacts(int number) const { return number != kWorld && bodies_[number].inv_mass > 0; }

 private:
  /// Where an object is found, by its index in its world. Half a cache line with floats.
  struct Slot {
    const btCollisionObject* object = nullptr;
    unsigned substep = 0;
    ContactEnd end;
  };

  /// What a part of the list comes to.
  struct Part {
    int bodies = 0, first = 0;  ///< that have a number, and the first of these
    bool regular = true;        ///< each is met once, and has a slot of its own
    bool renamed = false;       ///< some are where others were
  };

  void EnterInOrder(std::span<btCollisionObject* const> objects, const btContactSolverInfo& info);
  /// The same on several threads. False if not all are listed once, with a slot of their own that
  /// is there already: then nothing was done.
  bool EnterInParts(std::span<btCollisionObject* const> objects, const btContactSolverInfo& info,
                    detail::Threads* threads);
  /// Writes jointed_.
  void FindJointed(std::span<btTypedConstraint* const> joints);
  Part Count(std::span<btCollisionObject* const> objects);
  /// Those of bodies that are where others were, too.
  void EnterNames(std::span<btCollisionObject* const> objects);
  /// @pre it is in a world
  std::uint64_t NameOf(const btRigidBody& rigid);
  void EnterPart(std::span<btCollisionObject* const> objects, int first,
                 const btContactSolverInfo& info);
  /// One that has no slot yet, or none of its own.
  const ContactEnd& Enter(const btCollisionObject& object);
  /// Fills it where it stays: a copy would wait for what was just written.
  void Fill(const btCollisionObject& object, ContactEnd* end);
  /// What a end is, its number apart. Returns the body that is to have one, or nullptr.
  static btRigidBody* Describe(const btCollisionObject& object, ContactEnd* end);

  unsigned substep_ = 0;
  btScalar time_step_ = 0;
  std::vector<Slot> slots_;
  BodyNames names_;
  int growths_ = 0;
  /// By slot: the last substep in which several threads listed bodies and one came to it.
  std::unique_ptr<std::atomic<unsigned>[]> claims_;
  size_t claims_size_ = 0;
  std::vector<Part> parts_;
  /// Objects in no world, or with the index of another one from another world.
  std::unordered_map<const btCollisionObject*, Slot> strangers_;

  std::vector<Body> bodies_;
  std::vector<Motion> motions_;
  std::vector<btRigidBody*> rigids_;
  std::vector<char> jointed_;  ///< by number, while stiffness is looked for
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
