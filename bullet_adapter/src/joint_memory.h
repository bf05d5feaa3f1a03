// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "address_index.h"
#include "cairn/bullet/precision.h"
#include "group_problem.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// Impulses of joints from one solved group to the next, to start from, and from when a joint fell
/// asleep to when it wakes. Nobody tells when a joint is removed, and another one may get its
/// address: a joint is the one that is remembered only if its type and bodies are, and if it still
/// has the applied impulse that it was left with. Of its rows those start from before that point
/// where one did, in the same order: limits that are met and left leave the others as they are.
class JointMemory {
 public:
  /// Begins a group; the applied impulses of the joints must be as the last group left them.
  /// @param factor     of the start for a step as long as the last, at least 0, which starts cold
  /// @param time_step  of the group [s]
  /// @param units_per_metre  see Tuning: rows are as alike in metres
  /// @param group      has the last one, which is taken away; is left empty
  void Begin(std::span<btTypedConstraint* const> joints, btScalar factor, btScalar time_step,
             double units_per_metre, GroupProblem* group);
  /// Sets the start of the joint with that place in the group.
  void Start(int place, const JointRows& joint, GroupProblem* group);
  /// In place of Keep(): remembers what it did before Begin().
  /// @param group  of Begin(), which gets back what it had
  void Unread(GroupProblem* group);
  /// Remembers a solved group, once its impulses are written to the joints.
  void Keep(const GroupProblem& group);
  void Forget();

 private:
  /// What a joint is known by.
  struct Entry {
    const btRigidBody *body_a, *body_b;
    int type;
    btScalar applied_impulse;
    btScalar time_step;          ///< [s]
    std::int64_t met_in = 0;     ///< the later group that it was in, 0 for none
    std::int64_t asleep_as = 0;  ///< the how manieth, of those asleep

    bool Is(const btTypedConstraint& joint, btScalar applied) const;
  };
  /// Joints, and their rows and impulses.
  struct Joints {
    GroupProblem problem;
    std::vector<Entry> entries;  ///< in the order of problem.joints
    AddressIndex index;          ///< of the entries

    void Clear();
  };
  /// Those that have been in no group since, and some that were removed or met again: going over
  /// them all is put off until there are twice as many.
  struct Asleep : Joints {
    std::int64_t fell_asleep = 0;  ///< how many ever have
    std::size_t most = kFew;       ///< entries until that is due

    void FallAsleep(Entry entry, const JointRows& rows, const GroupProblem& from);

   private:
    static constexpr std::int64_t kMost = 1 << 14;
    static constexpr std::size_t kFew = 64;

    void DropOthers();
  };

  bool StartFrom(Joints* joints, int place, const JointRows& joint, GroupProblem* group);
  void KeepThoseAsleep();

  btScalar factor_ = 0, time_step_ = 0;
  float lever_ = 1;                ///< What products of levers count beside those of directions.
  std::vector<btScalar> applied_;  ///< of the present joints, by place
  Joints last_;                    ///< those of the last group
  Asleep asleep_;
  std::int64_t groups_ = 0;  ///< so far, with the present one
  bool kept_ = false;        ///< the present group was
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
