// SPDX-License-Identifier: MIT
#include "joint_memory.h"

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "prefetch.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

/// Least cosine between a row and the row that it is taken for. A hinge that turns by 25 degrees in
/// a step keeps its start.
constexpr float kAlike = 0.9f;

/// What rows that only turn bodies start from, of the factor: sweeps pass on bending so slowly that
/// what they add from substep to substep comes late, and swings up beams and arms of servos.
constexpr float kTurning = 0.6f;

/// What rows have in common: the products of two of them with each other and with themselves.
struct Products {
  float ab = 0, aa = 0, bb = 0;
};

template <class Vector>
float Dot(const Vector& a, const Vector& b) {
  return static_cast<float>(a[0]) * static_cast<float>(b[0]) +
         static_cast<float>(a[1]) * static_cast<float>(b[1]) +
         static_cast<float>(a[2]) * static_cast<float>(b[2]);
}

/// Without the half of a body that does not move: its lever reaches to the origin of the world.
/// @param lever  what the products of levers count, which are lengths
Products ProductsOf(const Row& a, const Row& b, const JointRows& joint, float lever) {
  Products products;
  if (joint.a_moves) {
    products.ab += Dot(a.linear_a, b.linear_a) + lever * Dot(a.angular_a, b.angular_a);
    products.aa += Dot(a.linear_a, a.linear_a) + lever * Dot(a.angular_a, a.angular_a);
    products.bb += Dot(b.linear_a, b.linear_a) + lever * Dot(b.angular_a, b.angular_a);
  }
  if (joint.b_moves) {
    products.ab += Dot(a.linear_b, b.linear_b) + lever * Dot(a.angular_b, b.angular_b);
    products.aa += Dot(a.linear_b, a.linear_b) + lever * Dot(a.angular_b, a.angular_b);
    products.bb += Dot(b.linear_b, b.linear_b) + lever * Dot(b.angular_b, b.angular_b);
  }
  return products;
}

/// Likewise, with the three numbers of a vector side by side.
Products ProductsOf(const JointRow& a, const JointRow& b, const JointRows& joint, float lever) {
  // a row is four vectors, each with a number behind it that does not count
  using Four = Eigen::Array4f;
  static_assert(sizeof(JointRow) == 16 * sizeof(float));
  const auto vector = [](const JointRow& row, int k) -> Four {
    return Eigen::Map<const Four>(reinterpret_cast<const float*>(&row) + 4 * k);
  };
  Four ab = Four::Zero(), aa = Four::Zero(), bb = Four::Zero();
  for (int k = joint.a_moves ? 0 : 2; k < (joint.b_moves ? 4 : 2); ++k) {
    const Four of_a = vector(a, k), of_b = vector(b, k);
    const float share = k % 2 == 0 ? 1 : lever;
    ab += share * (of_a * of_b);
    aa += share * (of_a * of_a);
    bb += share * (of_b * of_b);
  }
  const auto sum = [](const Four& four) { return four[0] + four[1] + four[2]; };
  return {sum(ab), sum(aa), sum(bb)};
}

template <class AnyRow>
float ShareOfRow(const AnyRow& row) {
  const float linear = Dot(row.linear_a, row.linear_a) + Dot(row.linear_b, row.linear_b);
  return linear == 0 ? kTurning : 1;
}

template <class AnyRow>
bool AllAlike(const AnyRow* a, const AnyRow* b, const JointRows& joint, float lever) {
  for (int i = 0; i < joint.rows; ++i) {
    const auto [ab, aa, bb] = ProductsOf(a[i], b[i], joint, lever);
    // rows that ask for nothing are alike
    const bool alike = (aa == 0 && bb == 0) || (ab > 0 && ab * ab >= kAlike * kAlike * aa * bb);
    if (!alike) return false;
  }
  return true;
}

}  // namespace

void JointMemory::Begin(std::span<btTypedConstraint* const> joints, btScalar factor,
                        double units_per_metre, GroupProblem* group) {
  constexpr size_t kAhead = 8;
  if (!std::exchange(kept_, false)) Forget();
  std::swap(last_, *group);
  group->Clear();
  factor_ = factor;
  lever_ = static_cast<float>(1 / (units_per_metre * units_per_metre));
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
    if (!AllAlike(&last_.rows[last.first_row], rows, joint, lever_)) return;
    for (int i = 0; i < joint.rows; ++i) {
      const btScalar factor = factor_ * btScalar(ShareOfRow(rows[i]));
      group->impulses[joint.first_row + i] = factor * last_.impulses[last.first_row + i];
    }
    return;
  }
  const JointRow* const rows = &group->joint_rows[joint.first_row];
  if (!AllAlike(&last_.joint_rows[last.first_row], rows, joint, lever_)) return;
  for (int i = 0; i < joint.rows; ++i) {
    const float factor = static_cast<float>(factor_) * ShareOfRow(rows[i]);
    group->joint_impulses[joint.first_row + i] = factor * last_.joint_impulses[last.first_row + i];
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
