// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "address_index.h"
#include "cairn/bullet/precision.h"
#include "group_problem.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// Impulses of joints from one solved group to the next, to start from. Nobody tells when a joint
/// is removed, and another one may get its address: a joint is the one that is remembered only if
/// its type, bodies and number of rows are, if it still has the applied impulse that it was left
/// with, and if its rows point where they pointed. Only the group before is remembered, so that
/// worlds which share a solver start cold.
class JointMemory {
 public:
  /// Begins a group; the applied impulses of the joints must be as the last group left them.
  /// @param factor  of the start, at least 0, which starts cold
  /// @param units_per_metre  see Tuning: rows are as alike in metres
  /// @param group   has the last one, which is taken away; is left empty
  void Begin(std::span<btTypedConstraint* const> joints, btScalar factor, double units_per_metre,
             GroupProblem* group);
  /// Sets the start of the joint with that place in the group.
  void Start(int place, const JointRows& joint, GroupProblem* group);
  /// Remembers a solved group, once its impulses are written to the joints.
  void Keep(const GroupProblem& group);
  void Forget();

 private:
  /// What a joint is known by; its rows and impulses are in last_.
  struct Entry {
    const btRigidBody *body_a, *body_b;
    int type;
    btScalar applied_impulse;
  };

  btScalar factor_ = 0;
  float lever_ = 1;                ///< What products of levers count beside those of directions.
  std::vector<btScalar> applied_;  ///< of the present joints, by place
  std::vector<Entry> entries_;     ///< of the last group, in the order of its joints
  GroupProblem last_;
  bool kept_ = false;   ///< the present group was
  AddressIndex index_;  ///< of the entries
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
