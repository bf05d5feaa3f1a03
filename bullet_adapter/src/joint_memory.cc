// SPDX-License-Identifier: MIT
#include "joint_memory.h"

#include <utility>

#include "prefetch.h"

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

void JointMemory::Memory::Clear() {
  entries.clear();
  directions.clear();
  impulses.clear();
}

void JointMemory::Begin(std::span<btTypedConstraint* const> joints, btScalar factor) {
  constexpr size_t kAhead = 8;
  factor_ = factor;
  index_.Rewind();
  now_.Clear();
  applied_.clear();
  for (size_t i = 0; i < joints.size(); ++i) {
    if (i + kAhead < joints.size()) PrefetchJoint(*joints[i + kAhead], kHeadOfJoint);
    applied_.push_back(joints[i]->internalGetAppliedImpulse());
  }
}

void JointMemory::Start(int place, const JointRows& joint, GroupProblem* group) {
  const Entry& now = now_.entries.emplace_back(
      Entry{&joint.joint->getRigidBodyA(), &joint.joint->getRigidBodyB(),
            joint.joint->getConstraintType(), static_cast<int>(now_.directions.size()), joint.rows,
            applied_[place]});
  for (int i = 0; i < joint.rows; ++i) {
    now_.directions.push_back(DirectionOf(group->rows[joint.first_row + i]));
  }
  if (factor_ == 0) return;
  const int found = index_.Find(joint.joint);
  if (found < 0) return;
  const Entry& last = last_.entries[found];
  const bool same = last.type == now.type && last.body_a == now.body_a &&
                    last.body_b == now.body_b && last.rows == now.rows &&
                    last.applied_impulse == now.applied_impulse;
  if (!same || !PointAlike(last, now)) return;
  for (int i = 0; i < joint.rows; ++i) {
    group->impulses[joint.first_row + i] = factor_ * last_.impulses[last.first_row + i];
  }
}

bool JointMemory::PointAlike(const Entry& last, const Entry& now) const {
  for (int i = 0; i < now.rows; ++i) {
    const Direction& before = last_.directions[last.first_row + i];
    if (!Alike(before, now_.directions[now.first_row + i])) return false;
  }
  return true;
}

void JointMemory::Keep(const GroupProblem& group) {
  std::swap(last_, now_);
  index_.Clear();
  for (size_t i = 0; i < group.joints.size(); ++i) {
    const JointRows& joint = group.joints[i];
    index_.Add(joint.joint);
    last_.entries[i].applied_impulse = joint.joint->internalGetAppliedImpulse();
    const auto first = group.impulses.begin() + joint.first_row;
    last_.impulses.insert(last_.impulses.end(), first, first + joint.rows);
  }
}

void JointMemory::Forget() {
  index_.Clear();
  last_.Clear();
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
