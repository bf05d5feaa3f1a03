// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "measure/contact_frame.h"

namespace cairn::micro {

using Block6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// A row of G: numbers of bodies in the matrix, -1 for what does not move.
struct BodyRow {
  int a = -1, b = -1;
  Vector6 g_a, g_b;
};

/// What a subspace step factorises in a frame of a scene, H = I + G' W G: a block for each body
/// that moves, and one for each pair of them that shares rows.
struct BodyMatrix {
  int bodies = 0;
  std::vector<std::pair<int, int>> pairs;  ///< ascending, first < second
  std::vector<Block6> diagonals;           ///< one per body
  std::vector<Block6> uppers;  ///< one per pair: rows of the first, columns of the second
  int rows = 0;                ///< of G with a weight
  std::vector<BodyRow> all_rows;
  bench::ContactFrame frame;  ///< where it comes from
};

/// @p scene: name, or name:size, or name@frame (frames::ParseScene). Rows that Bullet's own solver
/// leaves inside their bounds have weights 1 / (E + eps d), eps = 3e-3 with contacts and 1e-4 with
/// joints; the others have none, but keep their pair.
BodyMatrix MakeBodyMatrix(const std::string& scene);

}  // namespace cairn::micro
