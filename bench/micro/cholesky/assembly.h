// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <utility>
#include <vector>

#include "micro/cholesky/body_matrix.h"
#include "pack/block_frame.h"
#include "runtime/crew.h"
#include "simd/pairs/pair_products.h"
#include "step/block_system.h"

namespace cairn::micro {

/// Multiplications and additions of H = I + G' W G that any assembly row by row needs: of each body
/// of a row a triangle, of two bodies a square too.
double AssemblyFlops(const BodyMatrix& matrix);

/// What a subspace step does: assembly from rows in blocks, several pairs at a time, and
/// factorisation.
template <class T>
class BlockAssembly {
 public:
  explicit BlockAssembly(const BodyMatrix& matrix);

  /// With a weight of 1 for each row. False if a factorisation fails.
  [[nodiscard]] bool AssembleAndFactorise();

 private:
  BlockFrame frame_;
  Crew crew_{1};
  std::vector<BlockSystem<T>> systems_;                ///< one per group
  std::vector<std::vector<simd::LineOf<T>>> weights_;  ///< likewise
  Array<simd::LineOf<T>> scratch_;
};

extern template class BlockAssembly<float>;
extern template class BlockAssembly<double>;

/// The same matrix in Eigen's form, its upper triangle, in double, row by row.
class EigenAssembly {
 public:
  /// @param position  of each body in the order of elimination
  EigenAssembly(const BodyMatrix& matrix, std::span<const int> position);

  /// As a user of Eigen would who knows no better: setFromTriplets().
  void FromTriplets();
  /// Adds into the pattern of the last FromTriplets(), at places found before.
  void IntoPattern();
  const Eigen::SparseMatrix<double>& sparse() const { return sparse_; }

 private:
  /// Where the columns of a block begin among the values.
  struct Places {
    Eigen::Index column[6];
  };
  struct RowPlaces {
    int a = -1, b = -1, pair = -1;  ///< into places_; -1: none
    bool swapped = false;           ///< the columns of the pair's block are those of a
  };

  Places PlacesOf(int row, int column);

  const BodyMatrix& matrix_;
  std::vector<int> position_;
  Eigen::SparseMatrix<double> sparse_;
  std::vector<Eigen::Triplet<double>> triplets_;
  std::vector<Places> places_;
  std::vector<RowPlaces> row_places_;
};

}  // namespace cairn::micro
