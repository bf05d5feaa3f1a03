// SPDX-License-Identifier: MIT
#include "simd/rows/joint_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/rows/joint_rows.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/rows/joint_rows-inl.h"

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {

JointRowsKernel JointRowsKernelFor(Target target) {
  return CAIRN_DISPATCH(target, contacts::PackJoints);
}

}  // namespace cairn::simd
#endif
