// SPDX-License-Identifier: MIT
#include "simd/row_pack.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/row_pack.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/row_pack-inl.h"

#if HWY_ONCE
namespace cairn::simd {

RowPackKernel RowPackKernelFor(Target target) {
  switch (target) {
#if HWY_TARGETS & HWY_SSE4
    case Target::kSse4:
      return N_SSE4::rows::PackRow;
#endif
#if HWY_TARGETS & HWY_AVX2
    case Target::kAvx2:
      return N_AVX2::rows::PackRow;
#endif
#if HWY_TARGETS & HWY_AVX3
    case Target::kAvx512:
      return N_AVX3::rows::PackRow;
#endif
    default:
      break;
  }
  // what every CPU runs that this program was compiled for: plain C++ unless flags say more
  return HWY_STATIC_DISPATCH(rows::PackRow);
}

}  // namespace cairn::simd
#endif
