// SPDX-License-Identifier: MIT
#include "worlds/merit.h"

#include <cmath>
#include <vector>

#include "measure/row_velocities.h"
#include "problem/contact_expansion.h"
#include "problem/islands.h"

namespace cairn::bench {
namespace {

Audit AuditRows(const ContactProblem& problem, std::span<const double> x) {
  const std::vector<Velocity> free = FreeVelocities(problem.bodies);
  std::vector<Velocity> change(problem.bodies.size());
  Push(problem, x, change);

  Audit worst;
  double most = -kInfinity;
  for (const Island& island : FindIslands(problem)) {
    double energy = 0, work = 0, turned = 0;
    for (const int i : island.rows) {
      const Row& row = problem.rows[i];
      const double asked = row.target - RowSpeed(row, free);
      energy += 0.5 * x[i] * (RowSpeed(row, change) + row.compliance * x[i]);
      work += asked * x[i];
      turned += std::abs(asked * x[i]);
    }
    const Audit audit{.merit = energy - work,
                      .tolerance = Audit::kLeast + Audit::kRounding * (energy + turned)};
    const double over = audit.merit - audit.tolerance;
    if (over <= most) continue;  // NaN is the worst
    most = over;
    worst = audit;
  }
  return worst;
}

}  // namespace

Audit AuditEnergy(const ContactProblem& problem, std::span<const double> impulses) {
  if (impulses.empty() || impulses.size() != AllRows(problem)) return {};
  std::vector<double> rows(impulses.begin(), impulses.begin() + problem.rows.size());
  std::vector<ContactImpulse> points(problem.points.size());
  std::vector<TwistImpulse> twists(problem.twists.size());
  std::vector<float> joint_rows(problem.joint_rows.size());
  const ContactExpansion expansion(
      problem, {.rows = rows, .points = points, .twists = twists, .joint_rows = joint_rows});
  return AuditRows(expansion.problem(), impulses);
}

}  // namespace cairn::bench
