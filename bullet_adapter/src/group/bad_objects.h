// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <string>
#include <vector>

#include "cairn/bullet/precision.h"
#include "group/group.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// What holds a number that no solver can take, a NaN say.
struct BadThings {
  std::vector<const btCollisionObject*> bodies;
  std::vector<const btTypedConstraint*> joints;
  std::vector<const btManifoldPoint*> points;
};

/// Leaves bad bodies and joints out of a group, and the contacts and joints of those bodies, so
/// that a NaN does not spread.
class BadObjects {
 public:
  /// Begins a group: leaves out the bodies that were bad in the last one, and still are.
  /// @return  false if there are none; others() is good until the next call
  bool CutThoseOfLast(const Group& group);
  /// Leaves out more of it, likewise. @p why: what was said of the first of them
  bool Cut(const Group& group, const BadThings& more, const std::string& why);
  Group others() const { return others_.WithUnits(units_per_metre_); }
  /// What was left out, and why: one sentence.
  const std::string& complaint() const { return complaint_; }

 private:
  bool IsBad(const btCollisionObject& body) const;
  void Sort(const Group& group);

  double units_per_metre_ = 1;
  BadThings bad_;          ///< bodies and joints by address
  std::vector<int> last_;  ///< NumberOf() the bodies: others may get their addresses
  PartOfGroup others_;
  std::string complaint_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
