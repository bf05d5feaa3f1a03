// SPDX-License-Identifier: MIT
#include "simd/raised_inertia.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/raised_inertia.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/raised_inertia-inl.h"

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {

RaiseKernel RaiseKernelFor(Target target) {
  return CAIRN_DISPATCH(target, raised_inertia::kKernel);
}

}  // namespace cairn::simd
#endif
