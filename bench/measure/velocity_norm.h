// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "cairn/contact_problem.h"
#include "cairn/detail/eigen.h"

namespace cairn::bench {

/// How far two sets of velocities of the same bodies are apart; infinity if one is not a number.
struct VelocityDistance {
  double rms = 0;  ///< sqrt(dv' M dv / mass of all bodies): all momenta count [m/s].
  double max = 0;  ///< Of a centre of mass, VelocityError() [m/s].
};

/// Measures velocities in the energy norm of the bodies of a problem.
class VelocityNorm {
 public:
  explicit VelocityNorm(std::span<const Body> bodies);

  /// @pre one velocity per body in both
  VelocityDistance Between(std::span<const Velocity> a, std::span<const Velocity> b) const;

 private:
  struct Mass {
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< along each axis [kg]
    Eigen::Matrix3d angular = Eigen::Matrix3d::Zero();  ///< [kg m^2]
  };

  std::vector<Mass> masses_;
  double total_mass_ = 0;
};

}  // namespace cairn::bench
