// SPDX-License-Identifier: MIT
#pragma once

#include <unordered_map>

#include "measure/substep.h"

namespace cairn::bench {

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
