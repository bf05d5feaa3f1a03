// SPDX-License-Identifier: MIT
#include "subspace/eigen_cholesky.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>

namespace cairn {
namespace {

/// Opens the column counts, which say what a factorisation will cost.
class CountingCholesky : public Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Upper,
                                                     Eigen::NaturalOrdering<int>> {
 public:
  const Eigen::VectorXi& column_counts() const { return m_nonZerosPerCol; }
};

}  // namespace

std::vector<int> MinimumDegreeOrder(const Eigen::SparseMatrix<double>& matrix) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(matrix, order);
  return {order.indices().begin(), order.indices().end()};
}

struct EigenCholesky::Impl {
  CountingCholesky factor;
  double flops = 0, nonzeros = 0;
};

EigenCholesky::EigenCholesky() : impl_(std::make_unique<Impl>()) {}
EigenCholesky::~EigenCholesky() = default;
EigenCholesky::EigenCholesky(EigenCholesky&&) noexcept = default;
EigenCholesky& EigenCholesky::operator=(EigenCholesky&&) noexcept = default;

void EigenCholesky::Analyse(const Eigen::SparseMatrix<double>& upper) {
  impl_->factor.analyzePattern(upper);
  impl_->flops = 0;
  impl_->nonzeros = 0;
  for (const double below : impl_->factor.column_counts()) {
    impl_->flops += (below + 1) * (below + 1);
    impl_->nonzeros += below + 1;
  }
}

double EigenCholesky::flops() const { return impl_->flops; }
double EigenCholesky::nonzeros() const { return impl_->nonzeros; }

bool EigenCholesky::Factorise(const Eigen::SparseMatrix<double>& upper) {
  impl_->factor.factorize(upper);
  return impl_->factor.info() == Eigen::Success;
}

void EigenCholesky::Solve(Eigen::VectorXd* rhs) const {
  impl_->factor.matrixL().solveInPlace(*rhs);
  impl_->factor.matrixU().solveInPlace(*rhs);
}

}  // namespace cairn
