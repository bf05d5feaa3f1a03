// SPDX-License-Identifier: MIT
#include "simd/rows/row_pack.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/rows/row_pack.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/rows/row_pack-inl.h"

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {

RowPackKernel RowPackKernelFor(Target target) { return CAIRN_DISPATCH(target, rows::PackRow); }

}  // namespace cairn::simd
#endif
