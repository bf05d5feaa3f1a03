// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/eigen.h"

namespace cairn {

/// Velocity at the end of the step, also where those of a problem count from its start.
inline Velocity EndOf(const ContactProblem& problem, std::span<const Velocity> velocities,
                      std::size_t body) {
  Velocity end = velocities[body];
  if (problem.motions.empty()) return end;
  const ContactMotion& motion = problem.motions[body];
  View(end.linear) += Eigen::Map<const Eigen::Vector3f>(motion.free_velocity).cast<double>();
  View(end.angular) += Eigen::Map<const Eigen::Vector3f>(motion.free_spin).cast<double>();
  return end;
}

}  // namespace cairn
