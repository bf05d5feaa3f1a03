// SPDX-License-Identifier: MIT
#include "simd/rows/contact_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/rows/contact_rows.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/rows/contact_rows-inl.h"

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {

const ContactKernels& ContactKernelsFor(Target target) {
  return CAIRN_DISPATCH(target, contacts::kContactKernels);
}

}  // namespace cairn::simd
#endif
