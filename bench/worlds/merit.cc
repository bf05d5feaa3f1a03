// SPDX-License-Identifier: MIT
#include "worlds/merit.h"

#include <algorithm>
#include <cmath>

#include "problem/contact_expansion.h"
#include "problem/islands.h"

namespace cairn::bench {
namespace {

using Eigen::Vector3d;

/// The velocity that impulses change, at a body, and the momenta that change it.
struct Motion {
  Vector3d impulse = Vector3d::Zero(), angular_impulse = Vector3d::Zero();
};

double SpeedOf(const Row& row, std::span<const Velocity> v) {
  double speed = 0;
  if (row.body_a != kWorld) {
    speed += row.linear_a.dot(v[row.body_a].linear) + row.angular_a.dot(v[row.body_a].angular);
  }
  if (row.body_b != kWorld) {
    speed += row.linear_b.dot(v[row.body_b].linear) + row.angular_b.dot(v[row.body_b].angular);
  }
  return speed;
}

void AddMomentum(const Row& row, double x, std::span<Motion> motions) {
  if (row.body_a != kWorld) {
    motions[row.body_a].impulse += x * row.linear_a;
    motions[row.body_a].angular_impulse += x * row.angular_a;
  }
  if (row.body_b != kWorld) {
    motions[row.body_b].impulse += x * row.linear_b;
    motions[row.body_b].angular_impulse += x * row.angular_b;
  }
}

/// 1/2 p' M^-1 p [J].
double EnergyOf(const Body& body, const Motion& motion) {
  return 0.5 * body.inv_mass * motion.impulse.dot(body.linear_factor.cwiseProduct(motion.impulse)) +
         0.5 * motion.angular_impulse.dot(body.inv_inertia * motion.angular_impulse);
}

std::vector<Velocity> FreeVelocities(std::span<const Body> bodies) {
  std::vector<Velocity> velocities;
  for (const Body& body : bodies) {
    Velocity& v = velocities.emplace_back(body.velocity);
    v.linear += body.inv_mass * body.linear_factor.cwiseProduct(body.impulse);
    v.angular += body.inv_inertia * body.angular_impulse;
  }
  return velocities;
}

Audit AuditRows(const ContactProblem& problem, std::span<const double> x) {
  std::vector<Motion> motions(problem.bodies.size());
  const std::vector<Velocity> free = FreeVelocities(problem.bodies);
  for (size_t i = 0; i < x.size(); ++i) AddMomentum(problem.rows[i], x[i], motions);

  Audit worst;
  double most = -kInfinity;
  for (const Island& island : FindIslands(problem)) {
    double energy = 0, work = 0, turned = 0;
    for (const int body : island.bodies) energy += EnergyOf(problem.bodies[body], motions[body]);
    for (const int row : island.rows) {
      const double asked = problem.rows[row].target - SpeedOf(problem.rows[row], free);
      energy += 0.5 * problem.rows[row].compliance * x[row] * x[row];
      work += asked * x[row];
      turned += std::abs(asked * x[row]);
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
