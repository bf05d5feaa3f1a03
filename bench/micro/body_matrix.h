// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

namespace cairn::micro {

using Block6 = Eigen::Matrix<double, 6, 6>;

/// What a subspace step factorises in a frame of a scene, H = I + G' W G: a block for each body
/// that moves, and one for each pair of them that shares rows.
struct BodyMatrix {
  int bodies = 0;
  std::vector<std::pair<int, int>> pairs;  ///< ascending, first < second
  std::vector<Block6> diagonals;           ///< one per body
  std::vector<Block6> uppers;  ///< one per pair: rows of the first, columns of the second
  int rows = 0;                ///< of G with a weight
};

/// @p scene: name, or name:size, or name@frame (frames::ParseScene). Rows that Bullet's own solver
/// leaves inside their bounds have weights 1 / (E + eps d), eps = 3e-3 with contacts and 1e-4 with
/// joints; the others have none, but keep their pair.
BodyMatrix MakeBodyMatrix(const std::string& scene);

}  // namespace cairn::micro
