// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

namespace cairn::bench {

/// Sparse Cholesky factor in the plainest form, independent of the one under test in core: rows
/// ordered by reverse Cuthill-McKee, and of each row of L everything from its first entry on.
class EnvelopeCholesky {
 public:
  /// @param matrix  symmetric, both triangles stored.
  explicit EnvelopeCholesky(const Eigen::SparseMatrix<double>& matrix);

  /// False if a pivot was not positive; then there is nothing to solve with.
  bool ok() const { return ok_; }
  /// Numbers stored, zeros within the envelope included.
  std::int64_t size() const { return static_cast<std::int64_t>(values_.size()); }
  /// matrix^-1 b. @pre ok(), one entry per row.
  Eigen::VectorXd Solve(const Eigen::VectorXd& b) const;

 private:
  /// Row i of L without its diagonal.
  Eigen::Map<const Eigen::VectorXd> Left(Eigen::Index i) const {
    return {values_.data() + begin_[i], i - first_[i]};
  }
  double Pivot(Eigen::Index i) const { return values_[begin_[i] + (i - first_[i])]; }
  void SetEnvelope(const Eigen::SparseMatrix<double>& matrix);
  bool Factorise();

  std::vector<int> order_, place_;   ///< Row of the matrix at each place, and back.
  std::vector<Eigen::Index> first_;  ///< First column of each row's envelope.
  std::vector<Eigen::Index> begin_;  ///< Where its values begin.
  std::vector<double> values_;
  bool ok_ = false;
};

/// Rows in the order of reverse Cuthill-McKee, which keeps neighbours close together. Every part of
/// an unconnected matrix starts at a row far from its others.
std::vector<int> ReverseCuthillMcKee(const Eigen::SparseMatrix<double>& matrix);

}  // namespace cairn::bench
