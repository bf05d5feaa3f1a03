// SPDX-License-Identifier: MIT
#include "simd/lane_numbers.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/lane_numbers.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/lane_numbers-inl.h"

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {

const LaneKernels& LaneKernelsFor(Target target) {
  return CAIRN_DISPATCH(target, numbers::kKernels);
}

}  // namespace cairn::simd
#endif
