// SPDX-License-Identifier: MIT
#include "simd/fronts/front_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/fronts/front_kernels.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/fronts/front_kernels-inl.h"

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {

template <>
const FrontKernels<float>& FrontKernelsFor(Target target) {
  return CAIRN_DISPATCH(target, fronts::kKernels<float>);
}
template <>
const FrontKernels<double>& FrontKernelsFor(Target target) {
  return CAIRN_DISPATCH(target, fronts::kKernels<double>);
}

}  // namespace cairn::simd
#endif
