// SPDX-License-Identifier: MIT
#include "simd/fronts/node_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/fronts/node_kernels.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/fronts/node_kernels-inl.h"

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {

template <>
const NodeKernels<float>& NodeKernelsFor(Target target) {
  return CAIRN_DISPATCH(target, nodes::kKernels<float>);
}
template <>
const NodeKernels<double>& NodeKernelsFor(Target target) {
  return CAIRN_DISPATCH(target, nodes::kKernels<double>);
}

}  // namespace cairn::simd
#endif
