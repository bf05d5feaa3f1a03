// SPDX-License-Identifier: MIT
#include "problem/whitening.h"

#include <Eigen/QR>
#include <cmath>

#include "problem/validate.h"

namespace cairn {

bool Whiten(const Body& body, WhitenedBody* whitened) {
  const Eigen::Vector3d inv_mass = body.inv_mass * View(body.linear_factor);
  whitened->linear = inv_mass.cwiseSqrt();
  const bool factored = FactorInertia(body.inv_inertia, &whitened->angular);
  const auto impulse = View(body.impulse), angular_impulse = View(body.angular_impulse);
  const auto inv_inertia = View(body.inv_inertia);
  whitened->free.linear = View(body.velocity.linear) + inv_mass.cwiseProduct(impulse);
  whitened->free.angular = View(body.velocity.angular) + inv_inertia * angular_impulse;

  // what is not finite ends up in one of the sums
  const double sum = View(whitened->free.linear).sum() + View(whitened->free.angular).sum() +
                     impulse.sum() + angular_impulse.sum() + inv_inertia.sum();
  return factored && std::isfinite(sum) && body.inv_mass >= 0 &&
         View(body.linear_factor).minCoeff() >= 0;
}

Eigen::Vector3d SeenFreeVelocity(const ContactProblem& problem, const WhitenedBody& whitened,
                                 int body) {
  if (problem.motions.empty()) return View(whitened.free.linear);
  return Eigen::Map<const Eigen::Vector3f>(problem.motions[body].free_velocity).cast<double>();
}

Eigen::Vector3d WhitenedFreeSpin(const ContactProblem& problem, const WhitenedBody& whitened,
                                 int body) {
  Eigen::Vector3d spin = View(whitened.free.angular);
  if (!problem.motions.empty()) {
    spin = Eigen::Map<const Eigen::Vector3f>(problem.motions[body].free_spin).cast<double>();
  }
  return whitened.angular.completeOrthogonalDecomposition().solve(spin);
}

Velocity Unwhiten(const WhitenedBody& body, const Eigen::Vector3d& linear,
                  const Eigen::Vector3d& angular) {
  return {View(body.free.linear) + body.linear.cwiseProduct(linear),
          View(body.free.angular) + body.angular * angular};
}

}  // namespace cairn
