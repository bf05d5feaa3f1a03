// SPDX-License-Identifier: MIT
#include "worlds/merit.h"

#include <array>
#include <cmath>
#include <vector>

#include "cairn/detail/eigen.h"
#include "measure/row_velocities.h"
#include "problem/contact_expansion.h"
#include "problem/islands.h"
#include "problem/locked_axes.h"
#include "problem/whitening.h"

namespace cairn::bench {
namespace {

bool IsLeftAlone(const Body& body, const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
  WhitenedBody whitened;
  Whiten(body, &whitened);
  std::array<double, 6> g;
  Eigen::Map<Eigen::Vector3d>(g.data()) = whitened.linear.cwiseProduct(linear);
  Eigen::Map<Eigen::Vector3d>(g.data() + 3) = whitened.angular.transpose() * angular;
  return LookAtLocked(body, linear.squaredNorm(), angular.squaredNorm(), g).alone;
}

/// Rows without the bodies that they do not move: such as have locked axes and are left alone, and
/// those that nothing moves.
std::vector<Row> RowsThatPush(const ContactProblem& problem) {
  std::vector<Row> rows(problem.rows.begin(), problem.rows.end());
  const auto look = [&problem](int* body, const auto& linear, const auto& angular) {
    if (*body == kWorld) return;
    const Body& of = problem.bodies[*body];
    const bool alone = HasLockedAxes(of) && IsLeftAlone(of, View(linear), View(angular));
    if (alone || !CanMove(of)) *body = kWorld;
  };
  for (Row& row : rows) {
    look(&row.body_a, row.linear_a, row.angular_a);
    look(&row.body_b, row.linear_b, row.angular_b);
  }
  return rows;
}

Audit AuditRows(const ContactProblem& problem, std::span<const double> x) {
  const std::vector<Velocity> free = FreeVelocities(problem.bodies);
  const std::vector<Row> push = RowsThatPush(problem);
  std::vector<Velocity> change(problem.bodies.size());
  Push({.bodies = problem.bodies, .rows = push}, x, change);

  Audit worst;
  double most = -kInfinity;
  for (const Island& island : FindIslands(problem)) {
    double energy = 0, work = 0, turned = 0;
    for (const int i : island.rows) {
      const Row& row = problem.rows[i];
      // what moves nothing asks for nothing
      if (push[i].body_a == kWorld && push[i].body_b == kWorld) continue;
      const double asked = row.target - RowSpeed(row, free);
      energy += 0.5 * x[i] * (RowSpeed(push[i], change) + row.compliance * x[i]);
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
