// SPDX-License-Identifier: MIT
#include "simd/joint_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/joint_rows.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/joint_rows-inl.h"

#if HWY_ONCE
namespace cairn::simd {

JointRowsKernel JointRowsKernelFor(Target target) {
  switch (target) {
#if HWY_TARGETS & HWY_SSE4
    case Target::kSse4:
      return N_SSE4::contacts::PackJoints;
#endif
#if HWY_TARGETS & HWY_AVX2
    case Target::kAvx2:
      return N_AVX2::contacts::PackJoints;
#endif
#if HWY_TARGETS & HWY_AVX3
    case Target::kAvx512:
      return N_AVX3::contacts::PackJoints;
#endif
    default:
      break;
  }
  // what every CPU runs that this program was compiled for: plain C++ unless flags say more
  return HWY_STATIC_DISPATCH(contacts::PackJoints);
}

}  // namespace cairn::simd
#endif
