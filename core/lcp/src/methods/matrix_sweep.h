// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "cairn/lcp/problem.h"
#include "runtime/crew.h"

namespace cairn::lcp {

/// A boxed LCP laid out for sweeps: its rows in the order of a sweep, each divided by its diagonal
/// entry, with the off-diagonal entries side by side. In natural order the columns above the
/// diagonal come first, ascending, and then those below it: the neighbour that a forward sweep has
/// just changed is the last one read, so that rows overlap in the pipeline.
struct SweepRows {
  std::vector<int> row;             ///< n: which row of the problem the k-th is.
  std::vector<int> begin;           ///< n + 1: where the entries of the k-th row begin.
  std::vector<int> columns;         ///< Off-diagonal entries.
  std::vector<double> values;       ///< M_ij / d_i
  std::vector<double> q, diagonal;  ///< n each: q_i / d_i and d_i.
  std::vector<double> lo, hi;       ///< n each.
  /// Where the rows of a colour begin, n last. Empty in natural order.
  std::vector<int> colours;

  int size() const { return static_cast<int>(diagonal.size()); }
};

/// The colour of each row: the lowest that no earlier neighbour has. Rows of a colour share no
/// entry of the matrix. Returns an empty vector if more than @p most colours are needed.
std::vector<int> ColourRows(const Eigen::SparseMatrix<double>& m, int most);

/// In natural order if @p colour_of is empty, else colour by colour.
SweepRows LayOut(const BoxedLcp& problem, const std::vector<int>& colour_of);

enum class Direction { kForward, kReverse };

/// One sweep of projected SOR: x_i := clamp(x_i - omega w_i / d_i), row after row. Returns
/// sum d_i (change of x_i)^2, an estimate of LcpResidual::energy squared that costs nothing.
double Sweep(const SweepRows& rows, double omega, Direction direction, double* x);

/// The same colour by colour, on so many threads. The result does not depend on their number.
/// @pre the rows are laid out by colour
double SweepColours(const SweepRows& rows, double omega, Crew* crew, double* x);

}  // namespace cairn::lcp
