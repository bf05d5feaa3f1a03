// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <span>
#include <vector>

#include "body_table.h"
#include "cairn/bullet/options.h"
#include "cairn/bullet/precision.h"
#include "contacts/contact_points.h"
#include "contacts/contact_row_builder.h"
#include "contacts/contact_softness.h"
#include "contacts/split_impulse.h"
#include "contacts/twist_memory.h"
#include "group/bad_objects.h"
#include "group/group.h"
#include "group_problem.h"
#include "joint_rows.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// The rows of a group without Bullet's set-up, and its results without Bullet's finish.
class FastGroup {
 public:
  FastGroup() = default;
  FastGroup(const FastGroup&) = delete;  // its parts point at each other
  FastGroup& operator=(const FastGroup&) = delete;

  /// Builds the rows and their start, for so many parts of the step. Of Bullet's objects it changes
  /// what can be done again: the directions of friction of the points, and what joints prepare.
  /// @param threads  that do it, and write back; must outlive the group
  void Read(const Group& group, const btContactSolverInfo& info, SweepLimits limits,
            const Options& options, int substeps, detail::Threads* threads);
  /// Remembers what joints pull with, as solved. @pre Read()
  void Learn(const btContactSolverInfo& info, const Report& report);

  ContactProblem problem() const;
  Impulses impulses() {
    return {.rows = group_.impulses,
            .points = contacts_.impulses(),
            .twists = contacts_.twist_impulses(),
            .joint_rows = group_.joint_impulses};
  }
  std::span<Velocity> velocities() { return velocities_; }
  /// The most sweeps that a joint asks for.
  int most_sweeps() const { return joint_builder_.most_sweeps(); }

  /// Of a body in problem().bodies, -1 if it is not there.
  int place_of(const btRigidBody& body) const {
    const ContactEnd* const end = bodies_.Find(body);
    return end != nullptr && end->number != kWorld ? end->number : -1;
  }
  /// How many there are, or a little more.
  int rows() const;
  /// Whose rows they are.
  const GroupProblem& group() const { return group_; }
  /// Whose manifolds.
  const ContactPoints& contacts() const { return contacts_; }

  /// Whether the result is finite in Bullet's numbers.
  bool FitsBullet() const;
  /// Pushes bodies out of deep penetration, and writes everything to Bullet's objects.
  /// @param means  Solver::mean_velocities()
  void Write(const btContactSolverInfo& info, std::span<const Velocity> means);

  /// What Solve() refuses. @pre Read()
  BadThings FindBad();
  /// In place of Solve() and Write(): the group was not read. @pre Read()
  void Unread();

  /// In place of Solve() and Write() where all bodies are asleep. @pre Read()
  void Rest();

  /// Starts the next group cold where only this knows what it could start from.
  void Forget();
  /// The same, and bodies go by the names that they have in a new solver.
  void Reset();

 private:
  void ReadContacts(std::span<btPersistentManifold* const> manifolds,
                    const btContactSolverInfo& info, SweepLimits limits, FrictionBounds bounds,
                    ContactForm form, const ContactSoftness& softness, const ContactStart& start);
  void FindMotions();

  detail::Threads* threads_ = nullptr;
  BodyTable bodies_;
  GeometricStiffness stiffness_;
  /// What is known of the lengths of steps.
  struct Steps {
    btScalar last = 0;  ///< [s], 0 if there was none
    RestingStep resting;
  };
  Steps steps_, steps_before_;  ///< the present group included, and not
  int substeps_ = 1;
  const btContactSolverInfo* world_ = nullptr;  ///< whose tension stiffness_ knows
  GroupProblem group_;
  ContactPoints contacts_;
  std::vector<ContactMotion> motions_;  ///< one per body, if joints or contacts want them
  SplitImpulse pushes_;
  JointMemory joint_memory_;
  TwistMemory twist_memory_;
  JointRowBuilder joint_builder_{&bodies_, &joint_memory_, &group_};
  std::vector<Velocity> velocities_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
