// SPDX-License-Identifier: MIT
#include "simd/lane_numbers.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/lane_numbers.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/lane_numbers-inl.h"

#if HWY_ONCE
namespace cairn::simd {

const LaneKernels& LaneKernelsFor(Target target) {
  switch (target) {
#if HWY_TARGETS & HWY_SSE4
    case Target::kSse4: {
      static constexpr LaneKernels kKernels = N_SSE4::numbers::MakeLaneKernels();
      return kKernels;
    }
#endif
#if HWY_TARGETS & HWY_AVX2
    case Target::kAvx2: {
      static constexpr LaneKernels kKernels = N_AVX2::numbers::MakeLaneKernels();
      return kKernels;
    }
#endif
#if HWY_TARGETS & HWY_AVX3
    case Target::kAvx512: {
      static constexpr LaneKernels kKernels = N_AVX3::numbers::MakeLaneKernels();
      return kKernels;
    }
#endif
    default:
      break;
  }
  static constexpr LaneKernels kKernels = HWY_STATIC_DISPATCH(numbers::MakeLaneKernels());
  return kKernels;
}

}  // namespace cairn::simd
#endif
