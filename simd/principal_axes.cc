// SPDX-License-Identifier: MIT
#include "simd/principal_axes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/principal_axes.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/principal_axes-inl.h"

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {

PrincipalAxesKernel PrincipalAxesKernelFor(Target target) {
  return CAIRN_DISPATCH(target, principal_axes::kKernel);
}

}  // namespace cairn::simd
#endif
