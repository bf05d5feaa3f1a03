// SPDX-License-Identifier: MIT
#pragma once

#include "simd/pairs/pair_block.h"
#include "simd/target.h"

namespace cairn::simd {

/// Symmetric 3x3 matrices, their principal axes, and what turns about these: number k of lane l is
/// at [k][l]. Lanes that nobody asks for may hold anything.
struct PrincipalAxes {
  alignas(64) double matrix[6][kLanes] = {};  ///< xx yx zx yy zy zz, to be read.
  /// Its eigenvalues, ascending, to be written.
  alignas(64) double moment[3][kLanes] = {};
  /// Unit eigenvectors at right angles to each other, to be written: x y z of the first, of the
  /// second, of the third. Which way along its line a vector looks is not said.
  alignas(64) double axis[9][kLanes] = {};
};

/// Cyclic Jacobi, as many lanes at a time as a register holds, until no rotation of any lane there
/// is larger than rounding: moments are right to a few roundings of the largest. Same bits on every
/// target, whatever the other lanes hold. What is not finite makes its own lane so.
/// Source: Golub, Van Loan, Matrix Computations, 4th ed., 8.5.
using PrincipalAxesKernel = void (*)(PrincipalAxes* lanes);

/// @pre the CPU supports it
PrincipalAxesKernel PrincipalAxesKernelFor(Target target);

}  // namespace cairn::simd
