// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#if defined(__SSE2__) || defined(_M_X64)
#include <xmmintrin.h>
#define CAIRN_FLOAT_MODE_SSE 1
#elif defined(__aarch64__) && defined(__GNUC__)
#define CAIRN_FLOAT_MODE_ARM 1
#endif

namespace cairn::simd {

/// While it lives, numbers too small for a normal float count as zero: impulses that decay towards
/// zero would otherwise slow a sweep down by up to a hundred times. Every kernel has one, so that
/// the mode of the calling thread changes no bits.
///
/// One case is left to the CPU: what is below the smallest normal float before it is rounded, and
/// that float after, is this float on x86, and zero on ARM. No test has met it.
class FlushDenormals {
 public:
#if CAIRN_FLOAT_MODE_SSE
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | kFlushAndTreatAsZero); }
  ~FlushDenormals() { _mm_setcsr(before_); }

 private:
  static constexpr unsigned kFlushAndTreatAsZero = 0x8040;
  unsigned before_;
#elif CAIRN_FLOAT_MODE_ARM
  FlushDenormals() : before_(Mode()) { SetMode(before_ | kFlush); }
  ~FlushDenormals() { SetMode(before_); }

 private:
  /// FPCR, the register that says how numbers are rounded and flushed.
  static std::uint64_t Mode() {
    std::uint64_t mode;
    asm volatile("mrs %0, fpcr" : "=r"(mode));
    return mode;
  }
  // nothing that memory holds is computed on the wrong side of it
  static void SetMode(std::uint64_t mode) { asm volatile("msr fpcr, %0" : : "r"(mode) : "memory"); }
  static constexpr std::uint64_t kFlush = std::uint64_t{1} << 24;
  std::uint64_t before_;
#else
  FlushDenormals() {}
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
};

}  // namespace cairn::simd
