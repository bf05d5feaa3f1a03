// SPDX-License-Identifier: MIT
#include "methods/row_set.h"

namespace cairn::lcp {
namespace {

Side SideOf(double x, double lo, double hi, double tolerance) {
  if (x <= lo + tolerance) return Side::kLower;
  return x >= hi - tolerance ? Side::kUpper : Side::kFree;
}

}  // namespace

RowSet SetByDistance(const BoxedLcp& problem, const Eigen::VectorXd& x, double tolerance) {
  RowSet set(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    set[i] = SideOf(x[i], problem.lo[i], problem.hi[i], tolerance);
  }
  return set;
}

RowSet SetByNaturalMap(const BoxedLcp& problem, const Eigen::VectorXd& x, const Eigen::VectorXd& w,
                       double tolerance) {
  const Eigen::VectorXd goal = x - w.cwiseQuotient(problem.M.diagonal());
  return SetByDistance(problem, goal, tolerance);
}

void Clamp(const BoxedLcp& problem, Eigen::VectorXd* x) {
  *x = x->cwiseMax(problem.lo).cwiseMin(problem.hi);
}

}  // namespace cairn::lcp
