// SPDX-License-Identifier: MIT
// Matrices whose pattern is a graph.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "tests/core/support/factor_graphs.h"

namespace cairn::test {

/// A random matrix of that pattern, diagonally dominant if @p diagonal is 1 or more.
inline Eigen::MatrixXd RandomMatrix(const FactorGraph& graph, int node_size, double diagonal,
                                    std::uint64_t seed) {
  Random random(seed);
  const int size = graph.nodes * node_size;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  const auto fill = [&](int node, int other) {
    for (int i = 0; i < node_size; ++i) {
      for (int j = 0; j < node_size; ++j) {
        const int row = node * node_size + i, column = other * node_size + j;
        matrix(row, column) = matrix(column, row) = random.Uniform(-1, 1);
      }
    }
  };
  for (int node = 0; node < graph.nodes; ++node) fill(node, node);
  for (const auto& [i, j] : graph.pairs) fill(i, j);
  const Eigen::VectorXd sums = matrix.cwiseAbs().rowwise().sum();
  for (int i = 0; i < size; ++i) matrix(i, i) = diagonal * sums[i] + 1e-3;
  return matrix;
}

template <class T>
using Block = Eigen::Map<Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>>;

/// @p factor: FrontCholesky or LaneCholesky of that graph
template <class Factor>
void Fill(const FactorGraph& graph, int node_size, const Eigen::MatrixXd& matrix, Factor* factor) {
  using T = std::remove_reference_t<decltype(*factor->diagonal(0))>;
  factor->SetZero();
  for (int i = 0; i < graph.nodes; ++i) {
    Block<T>(factor->diagonal(i), node_size, node_size) =
        matrix.block(i * node_size, i * node_size, node_size, node_size).template cast<T>();
  }
  for (size_t pair = 0; pair < graph.pairs.size(); ++pair) {
    const auto [i, j] = graph.pairs[pair];
    Block<T>(factor->upper(static_cast<int>(pair)), node_size, node_size) =
        matrix.block(i * node_size, j * node_size, node_size, node_size).template cast<T>();
  }
}

inline std::vector<double> RandomVector(int size) {
  Random random(99);
  std::vector<double> values(size);
  for (double& value : values) value = random.Uniform(-1, 1);
  return values;
}

template <class T>
bool SameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace cairn::test
