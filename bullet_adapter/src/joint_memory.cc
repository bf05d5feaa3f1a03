// SPDX-License-Identifier: MIT
#include "joint_memory.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "cairn/detail/start.h"
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

template <class VectorA, class VectorB>
float Dot(const VectorA& a, const VectorB& b) {
  return static_cast<float>(a[0]) * static_cast<float>(b[0]) +
         static_cast<float>(a[1]) * static_cast<float>(b[1]) +
         static_cast<float>(a[2]) * static_cast<float>(b[2]);
}

/// Without the half of a body that does not move: its lever reaches to the origin of the world.
/// @param lever  what the products of levers count, which are lengths
template <class RowA, class RowB>
Products ProductsOf(const RowA& a, const RowB& b, const JointRows& joint, float lever) {
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
  // a row is four vectors, each with a number behind it that does not count; infinite ones would
  // raise exceptions of floating point
  using Four = Eigen::Array4f;
  static_assert(sizeof(JointRow) == 16 * sizeof(float));
  const auto vector = [](const JointRow& row, int k) -> Four {
    Four four = Eigen::Map<const Four>(reinterpret_cast<const float*>(&row) + 4 * k);
    four[3] = 0;
    return four;
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

template <class RowA, class RowB>
bool AreAlike(const RowA& a, const RowB& b, const JointRows& joint, float lever) {
  const auto [ab, aa, bb] = ProductsOf(a, b, joint, lever);
  // rows that ask for nothing are alike
  return (aa == 0 && bb == 0) || (ab > 0 && ab * ab >= kAlike * kAlike * aa * bb);
}

}  // namespace

bool JointMemory::Entry::Is(const btTypedConstraint& joint, btScalar applied) const {
  return type == joint.getConstraintType() && body_a == &joint.getRigidBodyA() &&
         body_b == &joint.getRigidBodyB() && applied_impulse == applied &&
         std::signbit(applied_impulse) == std::signbit(applied);
}

void JointMemory::Joints::Clear() {
  problem.Clear();
  entries.clear();
  index.Clear();
}

void JointMemory::Asleep::FallAsleep(Entry entry, const JointRows& rows, const GroupProblem& from) {
  entry.asleep_as = fell_asleep++;
  const auto copy = [&](const auto& all, auto* to, int first) {
    if (static_cast<int>(to->size()) < first + rows.rows) to->resize(first + rows.rows);
    std::copy_n(all.begin() + rows.first_row, rows.rows, to->begin() + first);
  };
  int place = index.Find(rows.joint);
  const bool fits = place >= 0 && problem.joints[place].rows == rows.rows &&
                    problem.joints[place].written_out == rows.written_out;
  if (!fits) {
    if (entries.size() >= most) DropOthers();
    place = static_cast<int>(entries.size());
    index.Put(rows.joint);
    entries.emplace_back();
    problem.joints.emplace_back().first_row =
        static_cast<int>(rows.written_out ? problem.rows.size() : problem.joint_rows.size());
  }
  entries[place] = entry;
  const int first = std::exchange(problem.joints[place], rows).first_row;
  problem.joints[place].first_row = first;
  if (rows.written_out) {
    copy(from.rows, &problem.rows, first);
    copy(from.impulses, &problem.impulses, first);
  } else {
    copy(from.joint_rows, &problem.joint_rows, first);
    copy(from.joint_impulses, &problem.joint_impulses, first);
  }
}

void JointMemory::Asleep::DropOthers() {
  size_t kept = 0;
  int rows = 0, compact_rows = 0;
  const auto is_last = [this](size_t i) {
    return index.Find(problem.joints[i].joint) == static_cast<int>(i);
  };
  const auto is_kept = [&](size_t i) {
    const Entry& entry = entries[i];
    return entry.met_in == 0 && entry.asleep_as >= fell_asleep - kMost && is_last(i);
  };
  for (size_t i = 0; i < entries.size(); ++i) {
    if (!is_kept(i)) continue;
    JointRows of_joint = problem.joints[i];
    const auto move = [&](auto* all, int to) {
      std::copy_n(all->begin() + of_joint.first_row, of_joint.rows, all->begin() + to);
    };
    int& end = of_joint.written_out ? rows : compact_rows;
    if (of_joint.written_out) {
      move(&problem.rows, end);
      move(&problem.impulses, end);
    } else {
      move(&problem.joint_rows, end);
      move(&problem.joint_impulses, end);
    }
    of_joint.first_row = std::exchange(end, end + of_joint.rows);
    problem.joints[kept] = of_joint;
    entries[kept++] = entries[i];
  }
  problem.joints.resize(kept);
  entries.resize(kept);
  problem.rows.resize(static_cast<size_t>(rows));
  problem.impulses.resize(static_cast<size_t>(rows));
  problem.joint_rows.resize(static_cast<size_t>(compact_rows));
  problem.joint_impulses.resize(static_cast<size_t>(compact_rows));
  index.Clear();
  for (const JointRows& joint : problem.joints) index.Put(joint.joint);
  most = std::max(kFew, 2 * kept);
}

void JointMemory::Begin(std::span<btTypedConstraint* const> joints, btScalar factor,
                        btScalar time_step, double units_per_metre, GroupProblem* group) {
  constexpr size_t kAhead = 8;
  if (!std::exchange(kept_, false)) last_.Clear();
  ++groups_;
  std::swap(last_.problem, *group);
  group->Clear();
  factor_ = factor;
  time_step_ = time_step;
  lever_ = static_cast<float>(1 / (units_per_metre * units_per_metre));
  if (factor == 0) asleep_ = {};
  last_.index.Rewind();
  applied_.clear();
  for (size_t i = 0; i < joints.size(); ++i) {
    if (i + kAhead < joints.size()) PrefetchJoint(*joints[i + kAhead], kHeadOfJoint);
    applied_.push_back(joints[i]->internalGetAppliedImpulse());
    if (joints[i]->isEnabled()) continue;
    // switched off, it does not sleep
    for (Joints* const known : {&last_, static_cast<Joints*>(&asleep_)}) {
      const int found = known->index.Find(joints[i]);
      if (found < 0) continue;
      Entry& entry = known->entries[found];
      if (entry.met_in == 0 && entry.Is(*joints[i], applied_[i])) entry.met_in = groups_;
    }
  }
}

void JointMemory::Start(int place, const JointRows& joint, GroupProblem* group) {
  if (factor_ == 0) return;
  if (StartFrom(&last_, place, joint, group) || asleep_.entries.empty()) return;
  StartFrom(&asleep_, place, joint, group);
}

bool JointMemory::StartFrom(Joints* joints, int place, const JointRows& joint,
                            GroupProblem* group) {
  const int found = joints->index.Find(joint.joint);
  if (found < 0) return false;
  Entry& entry = joints->entries[found];
  if (entry.met_in != 0 || !entry.Is(*joint.joint, applied_[place])) return false;
  entry.met_in = groups_;
  const JointRows& last = joints->problem.joints[found];
  if (last.a_moves != joint.a_moves || last.b_moves != joint.b_moves) return false;
  const double longer =
      ShareOfStart(static_cast<double>(entry.time_step), static_cast<double>(time_step_));
  const btScalar factor = factor_ * static_cast<btScalar>(longer);
  // a limit that is met or left is a row more or less, before or behind those that stay
  const auto start = [&](const auto& rows_before, const auto& impulses_before, const auto& rows_now,
                         auto* impulses_now) {
    using Impulse = std::remove_reference_t<decltype((*impulses_now)[0])>;
    int next = 0;
    for (int i = 0; i < joint.rows; ++i) {
      const auto& row = rows_now[joint.first_row + i];
      int before = next;
      while (before < last.rows &&
             !AreAlike(rows_before[last.first_row + before], row, joint, lever_)) {
        ++before;
      }
      if (before == last.rows) continue;
      next = before + 1;
      (*impulses_now)[joint.first_row + i] =
          static_cast<Impulse>(factor) * static_cast<Impulse>(ShareOfRow(row)) *
          static_cast<Impulse>(impulses_before[last.first_row + before]);
    }
  };
  const auto start_from = [&](const auto& rows_before, const auto& impulses_before) {
    joint.written_out
        ? start(rows_before, impulses_before, group->rows, &group->impulses)
        : start(rows_before, impulses_before, group->joint_rows, &group->joint_impulses);
  };
  const GroupProblem& from = joints->problem;
  last.written_out ? start_from(from.rows, from.impulses)
                   : start_from(from.joint_rows, from.joint_impulses);
  return true;
}

void JointMemory::Unread(GroupProblem* group) {
  std::swap(last_.problem, *group);
  last_.problem.Clear();
  kept_ = true;
  for (Joints* const known : {&last_, static_cast<Joints*>(&asleep_)}) {
    for (Entry& entry : known->entries) {
      if (entry.met_in == groups_) entry.met_in = 0;
    }
  }
}

void JointMemory::Keep(const GroupProblem& group) {
  KeepThoseAsleep();
  kept_ = true;
  last_.entries.clear();
  last_.index.Clear();
  for (const JointRows& rows : group.joints) {
    btTypedConstraint& joint = *rows.joint;
    // a new one has +0
    if (joint.internalGetAppliedImpulse() == 0) joint.internalSetAppliedImpulse(btScalar(-0.0));
    last_.index.Add(rows.joint);
    last_.entries.push_back({&joint.getRigidBodyA(), &joint.getRigidBodyB(),
                             joint.getConstraintType(), joint.internalGetAppliedImpulse(),
                             time_step_});
  }
}

void JointMemory::KeepThoseAsleep() {
  if (factor_ == 0) return;
  // those that were removed are among them
  for (size_t i = 0; i < last_.entries.size(); ++i) {
    if (last_.entries[i].met_in != 0) continue;
    asleep_.FallAsleep(last_.entries[i], last_.problem.joints[i], last_.problem);
  }
}

void JointMemory::Forget() {
  last_.Clear();
  asleep_ = {};
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
