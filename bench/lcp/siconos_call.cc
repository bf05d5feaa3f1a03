// SPDX-License-Identifier: MIT
#include "lcp/siconos_call.h"

#include <siconos/numerics/CSparseMatrix_internal.h>
#include <siconos/numerics/LCP_Solvers.h>
#include <siconos/numerics/LinearComplementarityProblem.h>
#include <siconos/numerics/NonSmoothDrivers.h>
#include <siconos/numerics/NumericsMatrix.h>
#include <siconos/numerics/NumericsSparseMatrix.h>
#include <siconos/numerics/NumericsVerbose.h>
#include <siconos/numerics/SolverOptions.h>
#include <siconos/numerics/SparseBlockMatrix.h>
#include <siconos/numerics/lcp_cst.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "lcp/siconos_guard.h"

namespace cairn::cli {
namespace {

static_assert(SICONOS_LCP_LEMKE == 200 && SICONOS_LCP_NSGS_SBM == 201 && SICONOS_LCP_PGS == 202 &&
                  SICONOS_LCP_CPG == 203 && SICONOS_LCP_LATIN == 204 &&
                  SICONOS_LCP_LATIN_W == 205 && SICONOS_LCP_NEWTONMIN == 208 &&
                  SICONOS_LCP_NEWTON_FB_FBLSA == 209 && SICONOS_LCP_PSOR == 210 &&
                  SICONOS_LCP_RPGS == 211 && SICONOS_LCP_PIVOT == 215 && SICONOS_LCP_MURTY == 217 &&
                  SICONOS_LCP_NEWTON_MIN_FBLSA == 218 && SICONOS_LCP_PIVOT_LUMOD == 220 &&
                  SICONOS_LCP_CONVEXQP_PG == 222,
              "siconos_methods.cc has other numbers than this Siconos");

/// Below the 1 that Siconos takes for the error before the first iteration.
constexpr double kAbsoluteTolerance = 0.5;

struct FreeMatrix {
  void operator()(NumericsMatrix* matrix) const {
    NM_clear(matrix);
    std::free(matrix);
  }
};
using Matrix = std::unique_ptr<NumericsMatrix, FreeMatrix>;

struct FreeOptions {
  void operator()(SolverOptions* options) const {
    solver_options_delete(options);
    std::free(options);
  }
};

/// Siconos frees what it is given.
template <typename T>
T* Allocate(Eigen::Index count) {
  void* memory = std::malloc(std::max<size_t>(1, static_cast<size_t>(count)) * sizeof(T));
  if (memory == nullptr) throw std::bad_alloc();
  return static_cast<T*>(memory);
}

Matrix ToSparse(const Eigen::SparseMatrix<double>& M) {
  const int n = static_cast<int>(M.rows());
  Matrix matrix(NM_create(NM_SPARSE, n, n));
  auto* csc = Allocate<CSparseMatrix>(1);
  csc->nzmax = M.nonZeros();
  csc->m = csc->n = n;
  csc->p = Allocate<CS_INT>(n + 1);
  csc->i = Allocate<CS_INT>(M.nonZeros());
  csc->x = Allocate<double>(M.nonZeros());
  csc->nz = -1;  // compressed
  std::copy_n(M.outerIndexPtr(), n + 1, csc->p);
  std::copy_n(M.innerIndexPtr(), M.nonZeros(), csc->i);
  std::copy_n(M.valuePtr(), M.nonZeros(), csc->x);
  matrix->matrix2->csc = csc;
  matrix->matrix2->origin = NSM_CSC;
  return matrix;
}

Matrix ToBlocks(const Eigen::SparseMatrix<double>& M) {
  const int n = static_cast<int>(M.rows());
  const Matrix sparse = ToSparse(M);
  Matrix matrix(NM_create(NM_SPARSE_BLOCK, n, n));
  if (matrix->matrix1 == nullptr) matrix->matrix1 = SBM_new();
  SBM_from_csparse(1, sparse->matrix2->csc, matrix->matrix1);
  return matrix;
}

Matrix ToDense(const Eigen::SparseMatrix<double>& M) {
  const int n = static_cast<int>(M.rows());
  Matrix matrix(NM_create(NM_DENSE, n, n));
  Eigen::Map<Eigen::MatrixXd>(matrix->matrix0, n, n) = M;
  return matrix;
}

Matrix ToSiconos(const Eigen::SparseMatrix<double>& M, SiconosStorage storage) {
  // The shortcut for a single row looks at the dense array, whatever the storage.
  if (M.rows() == 1) return ToDense(M);
  switch (storage) {
    case SiconosStorage::kDense:
      return ToDense(M);
    case SiconosStorage::kSparse:
      return ToSparse(M);
    case SiconosStorage::kSparseBlocks:
      return ToBlocks(M);
  }
  return nullptr;
}

}  // namespace

SiconosAnswer CallSiconos(const SiconosRequest& request) {
  SiconosAnswer answer;
  answer.z = request.lcp.start;
  if (answer.z.size() == 0) return answer;
  // CPG gives up where p' M p is below 2e-16, however small q is: hence a q that makes the absolute
  // tolerance kAbsoluteTolerance.
  const double q_norm = request.lcp.q.norm();
  const double factor = q_norm > 0 ? kAbsoluteTolerance / (q_norm * request.tolerance) : 1;
  Eigen::VectorXd q = factor * request.lcp.q, w = Eigen::VectorXd::Zero(q.size());
  answer.z *= factor;
  const Matrix matrix = ToSiconos(request.lcp.M, request.method.storage);
  LinearComplementarityProblem lcp{static_cast<int>(q.size()), matrix.get(), q.data()};
  const std::unique_ptr<SolverOptions, FreeOptions> options(
      solver_options_create(request.method.id));
  options->iparam[SICONOS_IPARAM_MAX_ITER] = request.max_iterations;
  options->dparam[SICONOS_DPARAM_TOL] =
      request.method.stop == SiconosStop::kAbsolute ? kAbsoluteTolerance : request.tolerance;

  answer.fatal = RunGuarded({.threads = request.threads, .call = [&] {
                               numerics_set_verbose(0);
                               answer.info = linearComplementarity_driver(&lcp, answer.z.data(),
                                                                          w.data(), options.get());
                             }});
  // NSGS overwrites its count of sweeps with its error: what it says is 0.
  answer.iterations = std::max(0, options->iparam[SICONOS_IPARAM_ITER_DONE]);
  answer.z /= factor;
  return answer;
}

bool SolveWithSiconos(const Eigen::SparseMatrix<double>& A, Eigen::MatrixXd* columns) {
  const Matrix matrix = ToSparse(A);
  bool is_solved = false;
  const std::string fatal =
      RunGuarded({.threads = 1, .call = [&] {
                    numerics_set_verbose(0);
                    is_solved = NM_Cholesky_factorize(matrix.get()) == 0 &&
                                NM_Cholesky_solve(matrix.get(), columns->data(),
                                                  static_cast<unsigned>(columns->cols())) == 0;
                  }});
  return fatal.empty() && is_solved && columns->allFinite();
}

}  // namespace cairn::cli
