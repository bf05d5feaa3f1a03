// SPDX-License-Identifier: MIT
#include "micro/cholesky/eigen_cholesky.h"

#include <Eigen/SparseCholesky>

namespace cairn::micro {

struct EigenCholesky::Impl {
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Upper, Eigen::NaturalOrdering<int>>
      factor;
};

EigenCholesky::EigenCholesky() : impl_(std::make_unique<Impl>()) {}
EigenCholesky::~EigenCholesky() = default;
EigenCholesky::EigenCholesky(EigenCholesky&&) noexcept = default;
EigenCholesky& EigenCholesky::operator=(EigenCholesky&&) noexcept = default;

void EigenCholesky::Analyse(const Eigen::SparseMatrix<double>& upper) {
  impl_->factor.analyzePattern(upper);
}

bool EigenCholesky::Factorise(const Eigen::SparseMatrix<double>& upper) {
  impl_->factor.factorize(upper);
  return impl_->factor.info() == Eigen::Success;
}

void EigenCholesky::Solve(Eigen::VectorXd* rhs) const {
  impl_->factor.matrixL().solveInPlace(*rhs);
  impl_->factor.matrixU().solveInPlace(*rhs);
}

}  // namespace cairn::micro
