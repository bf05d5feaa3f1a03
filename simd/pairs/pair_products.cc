// SPDX-License-Identifier: MIT
#include "simd/pairs/pair_products.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/pairs/pair_products.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/pairs/pair_products-inl.h"

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {

template <>
const PairProducts<float>& PairProductsFor(Target target) {
  return CAIRN_DISPATCH(target, products::kProducts<float>);
}
template <>
const PairProducts<double>& PairProductsFor(Target target) {
  return CAIRN_DISPATCH(target, products::kProducts<double>);
}

}  // namespace cairn::simd
#endif
