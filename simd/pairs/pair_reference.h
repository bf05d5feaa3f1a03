// SPDX-License-Identifier: MIT
#pragma once

#include "simd/pairs/pair_sweep.h"

namespace cairn::simd {

/// The kernels lane by lane, in plain C++: the specification of the others, operation for
/// operation, and the target "scalar".
const PairKernels& ReferencePairKernels();

}  // namespace cairn::simd
