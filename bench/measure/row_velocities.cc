// SPDX-License-Identifier: MIT
#include "measure/row_velocities.h"
#include "cairn/detail/eigen.h"

namespace cairn::bench {
namespace {

void Add(const Velocity& change, double factor, Velocity* velocity) {
  View(velocity->linear) += factor * View(change.linear);
  View(velocity->angular) += factor * View(change.angular);
}

}  // namespace

Velocity Respond(const Body& body, const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
  return {.linear = body.inv_mass * View(body.linear_factor).cwiseProduct(linear),
          .angular = View(body.inv_inertia) * angular};
}

std::vector<Velocity> FreeVelocities(std::span<const Body> bodies) {
  std::vector<Velocity> velocities;
  for (const Body& body : bodies) {
    velocities.push_back(body.velocity);
    Add(Respond(body, body.impulse, body.angular_impulse), 1, &velocities.back());
  }
  return velocities;
}

double RowSpeed(const Row& row, std::span<const Velocity> velocities) {
  double speed = 0;
  if (row.body_a != kWorld) {
    const Velocity& a = velocities[row.body_a];
    speed += View(row.linear_a).dot(View(a.linear)) + View(row.angular_a).dot(View(a.angular));
  }
  if (row.body_b != kWorld) {
    const Velocity& b = velocities[row.body_b];
    speed += View(row.linear_b).dot(View(b.linear)) + View(row.angular_b).dot(View(b.angular));
  }
  return speed;
}

void Push(const ContactProblem& problem, std::span<const double> impulses,
          std::span<Velocity> velocities) {
  for (size_t i = 0; i < problem.rows.size(); ++i) {
    const Row& row = problem.rows[i];
    const auto push = [&](int body, const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
      if (body == kWorld) return;
      Add(Respond(problem.bodies[body], linear, angular), impulses[i], &velocities[body]);
    };
    push(row.body_a, row.linear_a, row.angular_a);
    push(row.body_b, row.linear_b, row.angular_b);
  }
}

}  // namespace cairn::bench
