// SPDX-License-Identifier: MIT
#include "plan/row_kind.h"

namespace cairn {
namespace {

simd::RowBound BoundOf(const Row& row) {
  const bool below = row.lo > -kInfinity, above = row.hi < kInfinity;
  if (row.parent != kNoRow) {
    return below || above ? simd::RowBound::kCutFriction : simd::RowBound::kFriction;
  }
  if (!below && !above) return simd::RowBound::kFree;
  return row.lo == 0 && !above ? simd::RowBound::kPush : simd::RowBound::kOwn;
}

bool IsAngular(const Row& row) {
  const auto zero = [](const Vector3& v) { return v.x() == 0 && v.y() == 0 && v.z() == 0; };
  return zero(row.linear_a) && zero(row.linear_b);
}

/// All that HasValidKind() does not look at.
bool IsFinite(const Row& row, double impulse) {
  // zero times what is not finite is not zero
  double zero = 0 * row.target + 0 * row.compliance + 0 * impulse;
  for (int k = 0; k < 3; ++k) {
    zero += 0 * row.linear_a[k] + 0 * row.angular_a[k] + 0 * row.linear_b[k] + 0 * row.angular_b[k];
  }
  return zero == 0;
}

}  // namespace

bool HasShape(const Row& row, double omega, const simd::RowShape& shape) {
  return BoundOf(row) == shape.bound && (row.compliance > 0) == shape.soft &&
         (omega * row.relaxation != 1) == shape.relaxed && IsAngular(row) == shape.angular &&
         row.host.max_sweeps == shape.max_sweeps;
}

simd::RowShape ShapeOf(const Row& row, double omega) {
  return {.bound = BoundOf(row),
          .soft = row.compliance > 0,
          .relaxed = omega * row.relaxation != 1,
          .angular = IsAngular(row),
          .parent = -1,
          .max_sweeps = row.host.max_sweeps};
}

bool HasValidKind(const Row& row) {
  return row.compliance >= 0 && row.relaxation > 0 && row.relaxation < 2 && row.friction >= 0 &&
         row.friction < kInfinity && row.lo <= row.hi && row.lo < kInfinity &&
         row.hi > -kInfinity && (row.parent == kNoRow || (row.lo <= 0 && row.hi >= 0));
}

bool ReadKind(const ContactProblem& problem, int index, double impulse, double omega,
              RowKind* kind) {
  const Row& row = problem.rows[index];
  kind->a = row.body_a;
  kind->b = row.body_b;
  kind->parent = row.parent;
  kind->opposite = ActsOpposite(row);
  kind->shape = ShapeOf(row, omega);
  const int bodies = static_cast<int>(problem.bodies.size());
  const auto known = [bodies](int body) { return body >= kWorld && body < bodies; };
  return IsFinite(row, impulse) && HasValidKind(row) && known(row.body_a) && known(row.body_b) &&
         (row.body_a != row.body_b || row.body_a == kWorld);
}

}  // namespace cairn
