// SPDX-License-Identifier: MIT
#include "joint_memory.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

/// Least cosine between a row and the row that it is taken for. A hinge that turns by 25 degrees in
/// a step keeps its start.
constexpr float kAlike = 0.9f;

/// Without the half of a static body: its lever reaches to the origin of the world.
std::array<float, 12> DirectionOf(const Row& row) {
  std::array<float, 12> direction{};
  for (int k = 0; k < 3; ++k) {
    if (row.body_a != kWorld) {
      direction[k] = static_cast<float>(row.linear_a[k]);
      direction[3 + k] = static_cast<float>(row.angular_a[k]);
    }
    if (row.body_b != kWorld) {
      direction[6 + k] = static_cast<float>(row.linear_b[k]);
      direction[9 + k] = static_cast<float>(row.angular_b[k]);
    }
  }
  return direction;
}

bool Alike(const std::array<float, 12>& a, const std::array<float, 12>& b) {
  float ab = 0, aa = 0, bb = 0;
  for (size_t k = 0; k < a.size(); ++k) {
    ab += a[k] * b[k];
    aa += a[k] * a[k];
    bb += b[k] * b[k];
  }
  return ab > 0 && ab * ab >= kAlike * kAlike * aa * bb;
}

}  // namespace

void JointMemory::Begin(std::span<btTypedConstraint* const> joints, btScalar factor) {
  factor_ = factor;
  index_.Rewind();
  applied_.clear();
  for (btTypedConstraint* joint : joints) applied_.push_back(joint->internalGetAppliedImpulse());
}

void JointMemory::Start(int place, const JointRows& joint, GroupProblem* group) {
  if (factor_ == 0) return;
  const int found = index_.Find(joint.joint);
  if (found < 0) return;
  const Entry& entry = entries_[found];
  const bool same = entry.type == joint.joint->getConstraintType() &&
                    entry.body_a == &joint.joint->getRigidBodyA() &&
                    entry.body_b == &joint.joint->getRigidBodyB() && entry.rows == joint.rows &&
                    entry.applied_impulse == applied_[place];
  if (!same || !PointAlike(entry, joint, *group)) return;
  for (int i = 0; i < joint.rows; ++i) {
    group->impulses[joint.first_row + i] = factor_ * rows_[entry.first_row + i].impulse;
  }
}

bool JointMemory::PointAlike(const Entry& entry, const JointRows& joint,
                             const GroupProblem& group) const {
  for (int i = 0; i < joint.rows; ++i) {
    const KeptRow& kept = rows_[entry.first_row + i];
    if (!Alike(kept.direction, DirectionOf(group.rows[joint.first_row + i]))) return false;
  }
  return true;
}

void JointMemory::Keep(const GroupProblem& group) {
  Forget();
  for (const JointRows& joint : group.joints) {
    index_.Add(joint.joint);
    entries_.push_back({&joint.joint->getRigidBodyA(), &joint.joint->getRigidBodyB(),
                        joint.joint->getConstraintType(), static_cast<int>(rows_.size()),
                        joint.rows, joint.joint->internalGetAppliedImpulse()});
    for (int i = 0; i < joint.rows; ++i) {
      const int row = joint.first_row + i;
      rows_.push_back({DirectionOf(group.rows[row]), group.impulses[row]});
    }
  }
}

void JointMemory::Forget() {
  index_.Clear();
  entries_.clear();
  rows_.clear();
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
