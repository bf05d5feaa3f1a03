// SPDX-License-Identifier: MIT
#include "simd/gyroscopic.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/gyroscopic.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/gyroscopic-inl.h"

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {

const GyroscopicKernels& GyroscopicKernelsFor(Target target) {
  return CAIRN_DISPATCH(target, gyroscopic::kKernels);
}

}  // namespace cairn::simd
#endif
