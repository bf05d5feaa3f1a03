// SPDX-License-Identifier: MIT
#pragma once

#include <cairn/lcp/solver.h>

#include <dart/constraint/BoxedLcpSolver.hpp>
#include <string>

namespace cairn::dart {

/// Cairn as a solver of DART, in its place of Dantzig's:
///
///     auto solver = std::make_unique<dart::constraint::BoxedLcpConstraintSolver>(
///         std::make_shared<cairn::dart::BoxedLcpSolver>());
///     world->setConstraintSolver(std::move(solver));
///
/// DART hands in the dense matrix J M^-1 J' of a group, and rows of friction that name the row
/// whose impulse bounds them. Bounds are taken from the last impulses, the boxed problem is solved
/// by cairn::lcp, and so on until they agree. To be compiled as DART was, with or without NDEBUG:
/// the table of virtual functions depends on it.
class BoxedLcpSolver final : public ::dart::constraint::BoxedLcpSolver {
 public:
  /// @param tolerance  largest distance of a row from its law, relative to the largest of b, > 0
  explicit BoxedLcpSolver(double tolerance = 1e-4);

  const std::string& getType() const override { return getStaticType(); }
  static const std::string& getStaticType();

  /// @return whether x is finite, and with @p earlyTermination also within the tolerance
  bool solve(int n, double* A, double* x, double* b, int nub, double* lo, double* hi, int* findex,
             bool earlyTermination) override;
#ifdef NDEBUG
  bool canSolve(int, const double*) { return true; }
#else
  bool canSolve(int, const double*) override { return true; }
#endif

 private:
  double tolerance_;
  lcp::Solver solver_;
  lcp::BoxedLcp problem_;
};

/// Entries from one row to the next in the matrices of DART.
inline int RowLength(int n) { return n > 1 ? ((n - 1) | 3) + 1 : n; }

/// The largest |x_i - clamp(x_i - w_i / A_ii)| A_ii of w = A x - b, with the bounds of friction
/// from x [m/s]; infinity if x is not finite.
double LargestResidual(int n, const double* A, const double* x, const double* b, const double* lo,
                       const double* hi, const int* findex);

}  // namespace cairn::dart
