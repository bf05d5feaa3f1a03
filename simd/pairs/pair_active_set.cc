// SPDX-License-Identifier: MIT
#include "simd/pairs/pair_active_set.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/pairs/pair_active_set.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/pairs/pair_active_set-inl.h"

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {

template <>
const ActiveSetKernels<float>& ActiveSetKernelsFor(Target target) {
  return CAIRN_DISPATCH(target, active_sets::kKernels<float>);
}
template <>
const ActiveSetKernels<double>& ActiveSetKernelsFor(Target target) {
  return CAIRN_DISPATCH(target, active_sets::kKernels<double>);
}

}  // namespace cairn::simd
#endif
