// SPDX-License-Identifier: MIT
#include "measure/joint_impulses.h"

namespace cairn::bench {

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
