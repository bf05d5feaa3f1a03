// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "cairn/joints.h"
#include "cairn/solver.h"
#include "verify/answers.h"

namespace cairn::verify {

/// A direction in space as a unit quaternion w + x i + y j + z k.
struct Turn {
  double w = 1, x = 0, y = 0, z = 0;

  Eigen::Matrix3d Axes() const;
  /// After turning for a step about @p by [rad], which is small.
  Turn Moved(const Eigen::Vector3d& by) const;
};

/// A box, or a ball. Without mass it stays where it is.
struct Thing {
  double mass = 0;                                     ///< [kg]
  Eigen::Vector3d half = Eigen::Vector3d::Zero();      ///< Half the edges of a box [m].
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< Of the centre of mass [m].
  double radius = 0;                                   ///< Of a ball [m].
  Turn turn = {};
  Velocity velocity = {};
};

/// Two things joined where a point of both is, as they were built. -1: the world.
struct Pin {
  int a = 0, b = -1;
  Eigen::Vector3d in_a = Eigen::Vector3d::Zero(), in_b = Eigen::Vector3d::Zero();
};

/// A small engine around the solver, of sums, products, quotients and roots alone: where it comes
/// out differently on two machines, the solver did. y points up, the ground is at y = 0.
class PlainWorld {
 public:
  std::vector<Thing> things;
  std::vector<Pin> pins;
  double rolling_friction = 0;  ///< Of balls [m].

  explicit PlainWorld(const Settings& settings) : solver_(settings) {}

  void Step();
  /// All positions, directions, velocities and impulses.
  void AddTo(Hash* hash);

 private:
  void FindContacts();
  void TouchGround(int thing);
  void TouchBoxes(int upper, int lower);
  void TouchBalls(int a, int b);

  Solver solver_;
  Contacts contacts_;
  Joints joints_;
  std::vector<TouchPoint> found_;
};

}  // namespace cairn::verify
