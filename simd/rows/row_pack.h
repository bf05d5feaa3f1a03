// SPDX-License-Identifier: MIT
#pragma once

#include "simd/pairs/pair_block.h"
#include "simd/target.h"

namespace cairn::simd {

/// One number of every lane, in double precision.
struct alignas(64) DoubleLine {
  double lane[kLanes];
};

/// The bodies on one side of the lanes of a block: R with M^-1 = R R', and velocities without
/// constraints. Zeros for what cannot move.
struct BodyLines {
  DoubleLine linear[3];    ///< diagonal of the linear part of R
  DoubleLine angular[9];   ///< angular part of R, column by column
  DoubleLine velocity[6];  ///< linear, angular
};

/// One row of all lanes, as the caller has it.
struct SourceRows {
  const double* a[kLanes];  ///< six numbers of J: linear and angular part for the first body
  const double* b[kLanes];  ///< the same for the second
  DoubleLine target;
  DoubleLine compliance;
  DoubleLine relaxation;
};

/// Writes the lines of G, then target - J v and step = relaxation / d with d = |G|^2 + compliance,
/// computed in double precision. A row with d = 0, which nothing can satisfy, asks for nothing.
/// False if a number is not finite or does not fit a float with its square. Same bits on every
/// target.
using RowPackKernel = bool (*)(PairForm form, const SourceRows& rows, const BodyLines& a,
                               const BodyLines& b, Line* out);

/// @pre the CPU supports it
RowPackKernel RowPackKernelFor(Target target);

}  // namespace cairn::simd
