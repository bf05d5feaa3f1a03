// SPDX-License-Identifier: MIT
#include "subspace/cholesky.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <vector>

#include "subspace/eigen_cholesky.h"

namespace cairn {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Position of each body in a minimum degree order of the body graph.
std::vector<int> OrderBodies(int bodies, std::span<const BodyPair> pairs) {
  std::vector<Eigen::Triplet<double>> edges;
  edges.reserve(bodies + 2 * pairs.size());
  for (int i = 0; i < bodies; ++i) edges.emplace_back(i, i, 1.0);
  for (const auto& [i, j] : pairs) {
    edges.emplace_back(i, j, 1.0);
    edges.emplace_back(j, i, 1.0);
  }
  SparseMatrix graph(bodies, bodies);
  graph.setFromTriplets(edges.begin(), edges.end());

  const std::vector<int> order = MinimumDegreeOrder(graph);
  std::vector<int> position(bodies);
  for (int k = 0; k < bodies; ++k) position[order[k]] = k;
  return position;
}

}  // namespace

struct BlockCholesky::Impl {
  /// Where a block lies in the values of the matrix: its first entry, and from there the entries of
  /// each of its six columns.
  struct Slot {
    int column;   ///< block column, in elimination order
    int above;    ///< blocks above it in that column
    bool mirror;  ///< the elimination order turned the pair round
  };

  std::vector<int> position;
  std::vector<Slot> slots;  ///< one per pair
  std::vector<int> above;   ///< blocks above the diagonal, per block column
  std::vector<Block6, Eigen::aligned_allocator<Block6>> diagonals, uppers;
  SparseMatrix matrix;
  EigenCholesky factor;

  void BuildPattern();
  double* Column(int block_column, int k) {
    return matrix.valuePtr() + matrix.outerIndexPtr()[6 * block_column + k];
  }
};

void BlockCholesky::Impl::BuildPattern() {
  const int bodies = static_cast<int>(position.size());
  std::vector<std::vector<int>> rows(bodies);
  for (const Slot& slot : slots) rows[slot.column].push_back(slot.above);
  above.assign(bodies, 0);

  // block rows per column, ascending; the slots then count the blocks above theirs
  for (int c = 0; c < bodies; ++c) {
    std::sort(rows[c].begin(), rows[c].end());
    above[c] = static_cast<int>(rows[c].size());
  }
  for (Slot& slot : slots) {
    const std::vector<int>& column = rows[slot.column];
    const auto place = std::lower_bound(column.begin(), column.end(), slot.above);
    slot.above = static_cast<int>(place - column.begin());
  }

  // the upper triangle in compressed columns: whole blocks, then the triangle on the diagonal
  const int blocks = static_cast<int>(slots.size());
  matrix.resize(6 * bodies, 6 * bodies);
  matrix.resizeNonZeros(36 * blocks + 21 * bodies);
  int entry = 0;
  for (int c = 0; c < bodies; ++c) {
    for (int k = 0; k < 6; ++k) {
      matrix.outerIndexPtr()[6 * c + k] = entry;
      for (int r : rows[c]) {
        for (int l = 0; l < 6; ++l) matrix.innerIndexPtr()[entry++] = 6 * r + l;
      }
      for (int l = 0; l <= k; ++l) matrix.innerIndexPtr()[entry++] = 6 * c + l;
    }
  }
  matrix.outerIndexPtr()[6 * bodies] = entry;
  std::fill_n(matrix.valuePtr(), entry, 1.0);
}

BlockCholesky::BlockCholesky() : impl_(std::make_unique<Impl>()) {}
BlockCholesky::~BlockCholesky() = default;
BlockCholesky::BlockCholesky(BlockCholesky&&) noexcept = default;
BlockCholesky& BlockCholesky::operator=(BlockCholesky&&) noexcept = default;

void BlockCholesky::Analyse(int bodies, std::span<const BodyPair> pairs) {
  impl_->position = OrderBodies(bodies, pairs);
  impl_->slots.clear();
  for (const auto& [i, j] : pairs) {
    const int p = impl_->position[i], q = impl_->position[j];
    impl_->slots.push_back({.column = std::max(p, q), .above = std::min(p, q), .mirror = p > q});
  }
  impl_->diagonals.resize(bodies);
  impl_->uppers.resize(pairs.size());
  impl_->BuildPattern();

  impl_->factor.Analyse(impl_->matrix);
}

double BlockCholesky::factor_flops() const { return impl_->factor.flops(); }
double BlockCholesky::factor_nonzeros() const { return impl_->factor.nonzeros(); }
Block6& BlockCholesky::diagonal(int body) { return impl_->diagonals[body]; }
Block6& BlockCholesky::upper(int pair) { return impl_->uppers[pair]; }

bool BlockCholesky::Factorise() {
  for (size_t pair = 0; pair < impl_->slots.size(); ++pair) {
    const Impl::Slot& slot = impl_->slots[pair];
    const Block6& block = impl_->uppers[pair];
    for (int k = 0; k < 6; ++k) {
      Eigen::Map<Vector6d> column(impl_->Column(slot.column, k) + 6 * slot.above);
      if (slot.mirror) {
        column = block.row(k).transpose();
      } else {
        column = block.col(k);
      }
    }
  }
  for (size_t body = 0; body < impl_->diagonals.size(); ++body) {
    const int c = impl_->position[body];
    for (int k = 0; k < 6; ++k) {
      double* const column = impl_->Column(c, k) + 6 * impl_->above[c];
      Eigen::Map<Eigen::VectorXd>(column, k + 1) = impl_->diagonals[body].col(k).head(k + 1);
    }
  }
  return impl_->factor.Factorise(impl_->matrix);
}

void BlockCholesky::Solve(std::span<Vector6d> rhs) const {
  const size_t bodies = rhs.size();
  Eigen::VectorXd ordered(6 * bodies);
  for (size_t i = 0; i < bodies; ++i) ordered.segment<6>(6 * impl_->position[i]) = rhs[i];
  impl_->factor.Solve(&ordered);
  for (size_t i = 0; i < bodies; ++i) rhs[i] = ordered.segment<6>(6 * impl_->position[i]);
}

}  // namespace cairn
