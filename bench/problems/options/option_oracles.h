// SPDX-License-Identifier: MIT
// Solvers for the steps of an option's march that share nothing with cairn::Solver: they deliver
// the solutions that the problems come with.
#pragma once

#include "problems/problem.h"

namespace cairn::problems {

/// Solves a one-dimensional step exactly, in one elimination from the last row to the first and one
/// projected substitution back: Brennan and Schwartz, J. Finance 32 (1977) 449-462.
/// @pre M is tridiagonal and an M-matrix, lo = 0, hi = inf, and there is a k such that the solution
///      is 0 in the rows before k and positive from k on. A put has it: it is exercised where the
///      asset is cheap.
Eigen::VectorXd BrennanSchwartz(const BoxedLcp& step);

/// Solves a step by projected over-relaxation from its warm start until a sweep moves no row by
/// more than 1e-15 of the largest x, that is, to rounding. The relaxation is Young's for the sweep
/// without bounds, and best if the rows can be coloured in two colours.
/// @pre M is symmetric and strictly diagonally dominant.
Eigen::VectorXd RelaxToRounding(const Problem& step);

}  // namespace cairn::problems
