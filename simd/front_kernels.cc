// SPDX-License-Identifier: MIT
#include "simd/front_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/front_kernels.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/front_kernels-inl.h"

#if HWY_ONCE
namespace cairn::simd {
namespace {

template <class T>
const FrontKernels<T>& KernelsFor(Target target) {
  switch (target) {
#if HWY_TARGETS & HWY_SSE4
    case Target::kSse4: {
      static constexpr FrontKernels<T> kKernels = N_SSE4::fronts::MakeFrontKernels<T>();
      return kKernels;
    }
#endif
#if HWY_TARGETS & HWY_AVX2
    case Target::kAvx2: {
      static constexpr FrontKernels<T> kKernels = N_AVX2::fronts::MakeFrontKernels<T>();
      return kKernels;
    }
#endif
#if HWY_TARGETS & HWY_AVX3
    case Target::kAvx512: {
      static constexpr FrontKernels<T> kKernels = N_AVX3::fronts::MakeFrontKernels<T>();
      return kKernels;
    }
#endif
    default:
      break;
  }
  // what every CPU runs that this program was compiled for: plain C++ unless flags say more
  static constexpr FrontKernels<T> kKernels = HWY_STATIC_DISPATCH(fronts::MakeFrontKernels<T>());
  return kKernels;
}

}  // namespace

template <>
const FrontKernels<float>& FrontKernelsFor(Target target) {
  return KernelsFor<float>(target);
}
template <>
const FrontKernels<double>& FrontKernelsFor(Target target) {
  return KernelsFor<double>(target);
}

}  // namespace cairn::simd
#endif
