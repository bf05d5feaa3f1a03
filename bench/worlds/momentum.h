// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scenes/world.h"

namespace cairn::bench {

/// How far a solver lets momentum stray in a world without anything static: what velocities change
/// by in each step, seen where the bodies were before it. What the integrator makes of bodies that
/// turn does not count, nor does gravity. In double precision; angular momentum about the common
/// centre of mass.
/// @pre no body has gyroscopic terms
class MomentumWatch {
 public:
  /// To be called before each step, and after it. @param time_step  [s]
  void Begin(const World& world);
  void End(const World& world, double time_step);

  /// Of the sum of all changes, the largest so far, relative to the largest sum of the sizes of all
  /// momenta.
  double linear() const { return linear_ / linear_size_; }
  double angular() const { return angular_ / angular_size_; }

 private:
  /// A body before the step.
  struct Place {
    Eigen::Vector3d position;
    Eigen::Matrix3d inertia;
    double mass;
  };
  struct Momenta {
    Eigen::Vector3d linear, angular;
  };
  /// Of the present velocities in the places before.
  Momenta Sum(const World& world);

  std::vector<Place> places_;
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  double mass_ = 0;
  Momenta before_;
  Eigen::Vector3d linear_drift_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_drift_ = Eigen::Vector3d::Zero();
  double linear_ = 0, angular_ = 0, linear_size_ = 1e-30, angular_size_ = 1e-30;
};

}  // namespace cairn::bench
