// SPDX-License-Identifier: MIT
#pragma once

#include <array>
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
  /// @param factor  of the start, in [0, 1]; 0 starts cold.
  void Begin(std::span<btTypedConstraint* const> joints, btScalar factor);
  /// Sets the start of the joint with that place in the group. All joints with rows must come here,
  /// in the order of GroupProblem::joints.
  void Start(int place, const JointRows& joint, GroupProblem* group);
  /// Remembers a solved group, once its impulses are written to the joints.
  void Keep(const GroupProblem& group);
  void Forget();

 private:
  struct Entry {
    const btRigidBody *body_a, *body_b;
    int type, first_row, rows;
    btScalar applied_impulse;
  };
  using Direction = std::array<float, 12>;
  struct Memory {
    std::vector<Entry> entries;
    std::vector<Direction> directions;  ///< of their rows
    std::vector<double> impulses;       ///< likewise

    void Clear();
  };

  bool PointAlike(const Entry& last, const Entry& now) const;

  btScalar factor_ = 0;
  std::vector<btScalar> applied_;  ///< of the present joints, by place
  Memory last_;
  Memory now_;          ///< directions are read while they are in the cache
  AddressIndex index_;  ///< of the entries
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
