// SPDX-License-Identifier: MIT
#include "problem/whitening.h"

#include <cmath>

#include "problem/validate.h"

namespace cairn {

bool Whiten(const Body& body, WhitenedBody* whitened) {
  const Eigen::Vector3d inv_mass = body.inv_mass * body.linear_factor;
  whitened->linear = inv_mass.cwiseSqrt();
  const bool factored = FactorInertia(body.inv_inertia, &whitened->angular);
  whitened->free.linear = body.velocity.linear + inv_mass.cwiseProduct(body.impulse);
  whitened->free.angular = body.velocity.angular + body.inv_inertia * body.angular_impulse;

  // what is not finite ends up in one of the sums
  const double sum = whitened->free.linear.sum() + whitened->free.angular.sum() +
                     body.impulse.sum() + body.angular_impulse.sum() + body.inv_inertia.sum();
  return factored && std::isfinite(sum) && body.inv_mass >= 0 && body.linear_factor.minCoeff() >= 0;
}

Eigen::Vector3d SeenFreeVelocity(const ContactProblem& problem, const WhitenedBody& whitened,
                                 int body) {
  if (problem.motions.empty()) return whitened.free.linear;
  return Eigen::Map<const Eigen::Vector3f>(problem.motions[body].free_velocity).cast<double>();
}

Velocity Unwhiten(const WhitenedBody& body, const Eigen::Vector3d& linear,
                  const Eigen::Vector3d& angular) {
  return {body.free.linear + body.linear.cwiseProduct(linear),
          body.free.angular + body.angular * angular};
}

}  // namespace cairn
