// SPDX-License-Identifier: MIT
#include "simd/pairs/pair_law.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/pairs/pair_law.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/pairs/pair_law-inl.h"

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {

template <>
const PairLawKernels<float>& PairLawKernelsFor(Target target) {
  return CAIRN_DISPATCH(target, laws::kKernels<float>);
}
template <>
const PairLawKernels<double>& PairLawKernelsFor(Target target) {
  return CAIRN_DISPATCH(target, laws::kKernels<double>);
}

}  // namespace cairn::simd
#endif
