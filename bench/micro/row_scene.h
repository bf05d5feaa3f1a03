// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "micro/scene_kind.h"
#include "simd/pairs/pair_block.h"

namespace cairn::micro {

/// A body and how it would move without constraints.
struct SceneBody {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();
  double inv_mass = 0;
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();  ///< R, where R R' is the inverse inertia.
};

/// J = (linear, angular_a, -linear, angular_b).
struct SceneRow {
  Eigen::Vector3d linear, angular_a, angular_b;
  double target;  ///< -J v: the motion along the row is to end.
  double step;    ///< 1 / J M^-1 J'
  double limit;   ///< Friction coefficient, or -+ the bounds of RowBound::kOwn.
};

/// Rows in the units of mechanics, from which both kinds of memory are filled: that of the kernels
/// and that of Bullet.
struct RowScene {
  simd::PairForm form;
  std::vector<std::vector<simd::RowShape>> layouts;
  std::vector<SceneBody> bodies;  ///< The first does not move.

  struct Pair {
    int a, b;
    int layout;
    int first_row;
  };
  /// 16 that start at a multiple of 16 share no movable body and have one layout.
  std::vector<Pair> pairs;
  std::vector<SceneRow> rows;
};

/// A scene whose impulses are bounded: all that moves can stop, so no rows contradict each other.
/// @pre count, of pairs, is a multiple of 16
RowScene MakeRowScene(SceneKind kind, int count);

}  // namespace cairn::micro
