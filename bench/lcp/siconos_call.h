// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <string>

#include "lcp/siconos_method.h"

namespace cairn::cli {

/// Find z >= 0 with w = M z + q >= 0 and z' w = 0.
struct PlainLcp {
  Eigen::SparseMatrix<double> M;  ///< n x n, symmetric, compressed.
  Eigen::VectorXd q, start;       ///< n each, start >= 0.
};

/// One call of Siconos.
struct SiconosRequest {
  const SiconosMethod& method;
  const PlainLcp& lcp;
  double tolerance = 0;  ///< For |z - max(z - w, 0)| / |q|, > 0.
  int max_iterations = 0;
  int threads = 1;  ///< Of the BLAS that Siconos calls.
};

struct SiconosAnswer {
  Eigen::VectorXd z;
  int iterations = 0;
  int info = 0;       ///< What the solver returned: 0 if it is content.
  std::string fatal;  ///< Why Siconos wanted to end this program; empty if it did not.
};

/// Solves without a word on the terminal, and survives what Siconos would end the program for.
/// @pre q != 0, and no other thread writes to the terminal meanwhile
SiconosAnswer CallSiconos(const SiconosRequest& request);

/// Replaces every column b of `columns` by the solution of A x = b, with the sparse Cholesky
/// factorisation of Siconos. False if A is not positive definite.
bool SolveWithSiconos(const Eigen::SparseMatrix<double>& A, Eigen::MatrixXd* columns);

}  // namespace cairn::cli
