// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "cairn/report_details.h"
#include "cairn/settings.h"

namespace cairn {

/// Fewer sweeps after a step do not smooth what it leaves behind.
inline constexpr int kLeastSweepsAfterStep = 3;

/// Units of length in a metre.
inline double UnitOf(const Settings& settings) {
  const double set = settings.tuning.units_per_metre;
  return set > 0 ? set : 1;
}

/// Of all rows, in metres a second or rad/s. @p unit: UnitOf()
inline double Largest(const Residual& residual, double unit) {
  return std::max(residual.max / unit, residual.max_angular);
}

/// Largest() is no more than that. Without a division.
inline bool IsWithin(const Residual& residual, double most, double unit) {
  return residual.max <= most * unit && residual.max_angular <= most;
}

struct StepSettings {
  double proximal;         ///< Tuning::proximal, as adapted to the island
  double proximal_joints;  ///< Settings::proximal_joints
  int factorisations;      ///< at most, >= 1
  int refinements;         ///< solves with each factor, >= 1
  /// Whether impulses of joints become the smallest ones that move bodies as they do. Redundant
  /// joints contradict each other, and each step answers that with impulses of the contradiction
  /// divided by proximal_joints that cancel each other, and pile up from frame to frame. It takes
  /// one more factorisation.
  bool condense_joints = false;
};

struct StepResult {
  bool solved = false;  ///< false: a system could not be factorised, and the state is as it was
  int factorisations = 0;
  /// Largest d |x| of rows without bounds before they are condensed, and after the step [m/s] or
  /// [rad/s]: what an impulse would change its own row by, and so what floats round at 6e-8 of.
  double solved_joint_speed = 0, joint_speed = 0;

  /// From the caller's unit of length.
  void ToMetres(double unit) {
    solved_joint_speed /= unit;
    joint_speed /= unit;
  }
};

/// Solves with its factor that condensing joints takes: each leaves eps / (eps + l) of the velocity
/// along a mode with eigenvalue l unanswered.
inline constexpr int kCondensingSolves = 3;
/// Where condensed impulses of joints are still more than this share of what they were, joints are
/// not redundant but carry much: they are left as they were.
inline constexpr double kCondensed = 0.5;

}  // namespace cairn
