// SPDX-License-Identifier: MIT
// What was compiled once per target, by target. To be included where HWY_ONCE is, after Highway.
#pragma once

#include <hwy/highway.h>

#include "simd/target.h"

#if HWY_TARGETS & HWY_SSE4
#define CAIRN_IF_SSE4(TARGET, NAME, OTHER) ((TARGET) == Target::kSse4 ? N_SSE4::NAME : OTHER)
#else
#define CAIRN_IF_SSE4(TARGET, NAME, OTHER) OTHER
#endif
#if HWY_TARGETS & HWY_AVX2
#define CAIRN_IF_AVX2(TARGET, NAME, OTHER) ((TARGET) == Target::kAvx2 ? N_AVX2::NAME : OTHER)
#else
#define CAIRN_IF_AVX2(TARGET, NAME, OTHER) OTHER
#endif
#if HWY_TARGETS & HWY_AVX3
#define CAIRN_IF_AVX512(TARGET, NAME, OTHER) ((TARGET) == Target::kAvx512 ? N_AVX3::NAME : OTHER)
#else
#define CAIRN_IF_AVX512(TARGET, NAME, OTHER) OTHER
#endif
#if HWY_TARGETS & HWY_NEON
#define CAIRN_IF_NEON(TARGET, NAME, OTHER) ((TARGET) == Target::kNeon ? N_NEON::NAME : OTHER)
#else
#define CAIRN_IF_NEON(TARGET, NAME, OTHER) OTHER
#endif

/// NAME in the namespace of a target, OTHER for Target::kScalar.
#define CAIRN_DISPATCH_OR(TARGET, NAME, OTHER) \
  CAIRN_IF_AVX512(TARGET, NAME,                \
                  CAIRN_IF_AVX2(TARGET, NAME,  \
                                CAIRN_IF_SSE4(TARGET, NAME, CAIRN_IF_NEON(TARGET, NAME, OTHER))))

/// The same; for Target::kScalar what every CPU runs that this program was compiled for: plain C++
/// unless flags say more.
#define CAIRN_DISPATCH(TARGET, NAME) CAIRN_DISPATCH_OR(TARGET, NAME, HWY_STATIC_DISPATCH(NAME))
