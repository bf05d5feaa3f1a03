// SPDX-License-Identifier: MIT
#include "simd/pair_products.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/pair_products.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/pair_products-inl.h"

#if HWY_ONCE
namespace cairn::simd {
namespace {

template <class T>
const PairProducts<T>& ProductsFor(Target target) {
  switch (target) {
#if HWY_TARGETS & HWY_SSE4
    case Target::kSse4: {
      static constexpr PairProducts<T> kProducts = N_SSE4::products::MakePairProducts<T>();
      return kProducts;
    }
#endif
#if HWY_TARGETS & HWY_AVX2
    case Target::kAvx2: {
      static constexpr PairProducts<T> kProducts = N_AVX2::products::MakePairProducts<T>();
      return kProducts;
    }
#endif
#if HWY_TARGETS & HWY_AVX3
    case Target::kAvx512: {
      static constexpr PairProducts<T> kProducts = N_AVX3::products::MakePairProducts<T>();
      return kProducts;
    }
#endif
    default:
      break;
  }
  static constexpr PairProducts<T> kProducts = HWY_STATIC_DISPATCH(products::MakePairProducts<T>());
  return kProducts;
}

}  // namespace

template <>
const PairProducts<float>& PairProductsFor(Target target) {
  return ProductsFor<float>(target);
}
template <>
const PairProducts<double>& PairProductsFor(Target target) {
  return ProductsFor<double>(target);
}

}  // namespace cairn::simd
#endif
