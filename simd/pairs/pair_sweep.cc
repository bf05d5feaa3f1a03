// SPDX-License-Identifier: MIT
#include "simd/pairs/pair_sweep.h"

#include "simd/pairs/pair_reference.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/pairs/pair_sweep.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/pairs/pair_sweep-inl.h"

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {

const PairKernels& PairKernelsFor(Target target) {
  return CAIRN_DISPATCH_OR(target, kPairKernels, ReferencePairKernels());
}

}  // namespace cairn::simd
#endif
