// SPDX-License-Identifier: MIT
#include "joint_memory.h"

#include <cmath>
#include <utility>

#include "prefetch.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

/// Least cosine between a row and the row that it is taken for. A hinge that turns by 25 degrees in
/// a step keeps its start.
constexpr float kAlike = 0.9f;

template <class Vector>
float Dot(const Vector& a, const Vector& b) {
  return static_cast<float>(a[0]) * static_cast<float>(b[0]) +
         static_cast<float>(a[1]) * static_cast<float>(b[1]) +
         static_cast<float>(a[2]) * static_cast<float>(b[2]);
}

/// Without the half of a body that does not move: its lever reaches to the origin of the world.
template <class AnyRow>
bool Alike(const AnyRow& a, const AnyRow& b, const JointRows& joint) {
  float ab = 0, aa = 0, bb = 0;
  if (joint.a_moves) {
    ab += Dot(a.linear_a, b.linear_a) + Dot(a.angular_a, b.angular_a);
    aa += Dot(a.linear_a, a.linear_a) + Dot(a.angular_a, a.angular_a);
    bb += Dot(b.linear_a, b.linear_a) + Dot(b.angular_a, b.angular_a);
  }
  if (joint.b_moves) {
    ab += Dot(a.linear_b, b.linear_b) + Dot(a.angular_b, b.angular_b);
    aa += Dot(a.linear_b, a.linear_b) + Dot(a.angular_b, a.angular_b);
    bb += Dot(b.linear_b, b.linear_b) + Dot(b.angular_b, b.angular_b);
  }
  // rows that ask for nothing are alike
  return (aa == 0 && bb == 0) || (ab > 0 && ab * ab >= kAlike * kAlike * aa * bb);
}

template <class AnyRow>
bool AllAlike(const AnyRow* a, const AnyRow* b, const JointRows& joint) {
  for (int i = 0; i < joint.rows; ++i) {
    if (!Alike(a[i], b[i], joint)) return false;
  }
  return true;
}

}  // namespace

void JointMemory::Begin(std::span<btTypedConstraint* const> joints, btScalar factor,
                        GroupProblem* group) {
  constexpr size_t kAhead = 8;
  if (!std::exchange(kept_, false)) Forget();
  std::swap(last_, *group);
  group->Clear();
  factor_ = factor;
  index_.Rewind();
  applied_.clear();
  for (size_t i = 0; i < joints.size(); ++i) {
    if (i + kAhead < joints.size()) PrefetchJoint(*joints[i + kAhead], kHeadOfJoint);
    applied_.push_back(joints[i]->internalGetAppliedImpulse());
  }
}

void JointMemory::Start(int place, const JointRows& joint, GroupProblem* group) {
  if (factor_ == 0) return;
  const int found = index_.Find(joint.joint);
  if (found < 0) return;
  const Entry& entry = entries_[found];
  const JointRows& last = last_.joints[found];
  const bool same = entry.type == joint.joint->getConstraintType() &&
                    entry.body_a == &joint.joint->getRigidBodyA() &&
                    entry.body_b == &joint.joint->getRigidBodyB() &&
                    entry.applied_impulse == applied_[place] &&
                    std::signbit(entry.applied_impulse) == std::signbit(applied_[place]) &&
                    last.rows == joint.rows && last.written_out == joint.written_out &&
                    last.a_moves == joint.a_moves && last.b_moves == joint.b_moves;
  if (!same) return;
  if (joint.written_out) {
    const Row* const rows = &group->rows[joint.first_row];
    if (!AllAlike(&last_.rows[last.first_row], rows, joint)) return;
    for (int i = 0; i < joint.rows; ++i) {
      group->impulses[joint.first_row + i] = factor_ * last_.impulses[last.first_row + i];
    }
    return;
  }
  const JointRow* const rows = &group->joint_rows[joint.first_row];
  if (!AllAlike(&last_.joint_rows[last.first_row], rows, joint)) return;
  for (int i = 0; i < joint.rows; ++i) {
    group->joint_impulses[joint.first_row + i] =
        static_cast<float>(factor_) * last_.joint_impulses[last.first_row + i];
  }
}

void JointMemory::Keep(const GroupProblem& group) {
  kept_ = true;
  entries_.clear();
  index_.Clear();
  for (const JointRows& rows : group.joints) {
    btTypedConstraint& joint = *rows.joint;
    // a new one has +0
    if (joint.internalGetAppliedImpulse() == 0) joint.internalSetAppliedImpulse(btScalar(-0.0));
    index_.Add(rows.joint);
    entries_.push_back({&joint.getRigidBodyA(), &joint.getRigidBodyB(), joint.getConstraintType(),
                        joint.internalGetAppliedImpulse()});
  }
}

void JointMemory::Forget() {
  index_.Clear();
  entries_.clear();
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
