// SPDX-License-Identifier: MIT
#include "simd/pair_sweep.h"

#include "simd/pair_reference.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/pair_sweep.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/pair_sweep-inl.h"

#if HWY_ONCE
namespace cairn::simd {

const PairKernels& PairKernelsFor(Target target) {
  switch (target) {
    case Target::kScalar:
      break;
#if HWY_TARGETS & HWY_SSE4
    case Target::kSse4: {
      static const PairKernels kKernels = N_SSE4::MakePairKernels();
      return kKernels;
    }
#endif
#if HWY_TARGETS & HWY_AVX2
    case Target::kAvx2: {
      static const PairKernels kKernels = N_AVX2::MakePairKernels();
      return kKernels;
    }
#endif
#if HWY_TARGETS & HWY_AVX3
    case Target::kAvx512: {
      static const PairKernels kKernels = N_AVX3::MakePairKernels();
      return kKernels;
    }
#endif
    default:
      break;
  }
  return ReferencePairKernels();
}

}  // namespace cairn::simd
#endif
