// SPDX-License-Identifier: MIT
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace cairn::simd {

/// While it lives, numbers too small for a normal float count as zero: impulses that decay towards
/// zero would otherwise slow a sweep down by up to a hundred times. Every kernel has one, so that
/// the mode of the calling thread changes no bits.
class FlushDenormals {
 public:
#if defined(__SSE2__)
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | kFlushAndTreatAsZero); }
  ~FlushDenormals() { _mm_setcsr(before_); }

 private:
  static constexpr unsigned kFlushAndTreatAsZero = 0x8040;
  unsigned before_;
#else
  FlushDenormals() {}
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
};

}  // namespace cairn::simd
