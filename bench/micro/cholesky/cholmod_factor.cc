// SPDX-License-Identifier: MIT
#include "micro/cholesky/cholmod_factor.h"

#include <suitesparse/cholmod.h>

#include <algorithm>

// OpenBLAS, if it is the one that is linked.
extern "C" __attribute__((weak)) void openblas_set_num_threads(int threads);

namespace cairn::micro {

struct CholmodFactor::Impl {
  cholmod_common common;
  cholmod_sparse matrix{};
  cholmod_factor* factor = nullptr;
  cholmod_dense *solution = nullptr, *work_y = nullptr, *work_e = nullptr;
};

CholmodFactor::CholmodFactor(const Eigen::SparseMatrix<double>* upper)
    : impl_(std::make_unique<Impl>()) {
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  cholmod_start(&impl_->common);
  impl_->common.supernodal = CHOLMOD_SUPERNODAL;
  impl_->common.final_ll = 1;
  impl_->common.nmethods = 1;
  impl_->common.method[0].ordering = CHOLMOD_AMD;
  cholmod_sparse& matrix = impl_->matrix;
  matrix.nrow = matrix.ncol = static_cast<size_t>(upper->rows());
  matrix.nzmax = static_cast<size_t>(upper->nonZeros());
  matrix.p = const_cast<int*>(upper->outerIndexPtr());
  matrix.i = const_cast<int*>(upper->innerIndexPtr());
  matrix.x = const_cast<double*>(upper->valuePtr());
  matrix.stype = 1;
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = CHOLMOD_REAL;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.sorted = matrix.packed = 1;
  impl_->factor = cholmod_analyze(&matrix, &impl_->common);
}

CholmodFactor::~CholmodFactor() {
  cholmod_free_dense(&impl_->solution, &impl_->common);
  cholmod_free_dense(&impl_->work_y, &impl_->common);
  cholmod_free_dense(&impl_->work_e, &impl_->common);
  cholmod_free_factor(&impl_->factor, &impl_->common);
  cholmod_finish(&impl_->common);
}

bool CholmodFactor::Factorise() {
  cholmod_factorize(&impl_->matrix, impl_->factor, &impl_->common);
  return impl_->common.status == CHOLMOD_OK && impl_->factor->minor == impl_->factor->n;
}

void CholmodFactor::Solve(std::vector<double>* rhs) {
  cholmod_dense b{};
  b.nrow = b.nzmax = b.d = rhs->size();
  b.ncol = 1;
  b.x = rhs->data();
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_solve2(CHOLMOD_A, impl_->factor, &b, nullptr, &impl_->solution, nullptr, &impl_->work_y,
                 &impl_->work_e, &impl_->common);
  std::copy_n(static_cast<const double*>(impl_->solution->x), rhs->size(), rhs->data());
}

}  // namespace cairn::micro
