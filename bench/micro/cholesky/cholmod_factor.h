// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace cairn::micro {

/// CHOLMOD's supernodal Cholesky factorisation with its own minimum degree order: what others
/// factorise with. Only to be compared with.
class CholmodFactor {
 public:
  /// @p upper: upper triangle, compressed. Its values may change later, its pattern may not.
  explicit CholmodFactor(const Eigen::SparseMatrix<double>* upper);
  ~CholmodFactor();
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;

  bool Factorise();
  void Solve(std::vector<double>* rhs);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::micro
