// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <span>

namespace cairn {

/// Rows of a sparse symmetric matrix in the order in which a minimum degree method eliminates them.
/// The only user of Eigen's orderings.
/// @pre both triangles are stored, and the whole diagonal: without it Eigen takes every column for
/// a dense one, and does not order at all.
/// @param[out] order  one number a row
void MinimumDegreeOrder(const Eigen::SparseMatrix<double>& matrix, std::span<int> order);

}  // namespace cairn
