// SPDX-License-Identifier: MIT
#pragma once

#include "simd/pairs/pair_block.h"
#include "simd/target.h"

namespace cairn::simd {

/// Number k of lane l is at [k][l]; see cairn::Gyroscopes.
template <class Scalar>
using GyroscopicKernel = void (*)(Scalar time_step, const Scalar (*inv_moment)[kLanes],
                                  const Scalar (*turn)[kLanes], const Scalar (*spin)[kLanes],
                                  Scalar (*change)[kLanes]);

/// Same bits on every target.
struct GyroscopicKernels {
  GyroscopicKernel<float> of_floats;
  GyroscopicKernel<double> of_doubles;
};

/// @pre the CPU supports it
const GyroscopicKernels& GyroscopicKernelsFor(Target target);

}  // namespace cairn::simd
