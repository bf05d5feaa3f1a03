// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "scenes/world.h"

namespace cairn::bench {

/// How far a solver lets momentum stray in a world without anything static: what velocities change
/// by in each step, seen where the bodies were before it. What the integrator makes of bodies that
/// turn does not count, nor does gravity. Of angular momentum the solver owes nothing that Bullet's
/// rows take: a joint acts at two anchors, friction at a point of each body, and where these have
/// parted, a force turns the whole by at most force times gap. In double precision; angular
/// momentum about the common centre of mass.
/// @pre no body has gyroscopic terms
class MomentumWatch {
 public:
  /// Has the joints of the world say what they push with. The watch must outlive the world.
  void Listen(World* world);
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
  std::deque<btJointFeedback> feedback_;  ///< one per joint
  double gap_ = 0;                        ///< the largest before the step [m]
  double owed_by_rows_ = 0;               ///< sum of impulses times gap [N m s]
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  double mass_ = 0;
  Momenta before_;
  Eigen::Vector3d linear_drift_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_drift_ = Eigen::Vector3d::Zero();
  double linear_ = 0, angular_ = 0, linear_size_ = 1e-30, angular_size_ = 1e-30;
};

}  // namespace cairn::bench
