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
/// zero would otherwise slow a sweep down by up to a hundred times. Results are rounded to the
/// nearest, and nothing traps: lanes that nobody asks for divide by zero. Every kernel has one, or
/// its caller, so that the mode of the thread changes no bits. To write the mode takes as long as
/// some rows of a sweep: inside another one it is left as it is.
///
/// One case is left to the CPU: what is below the smallest normal float before it is rounded, and
/// that float after, is this float on x86, and zero on ARM. No test has met it.
class FlushDenormals {
 public:
#if CAIRN_FLOAT_MODE_SSE || CAIRN_FLOAT_MODE_ARM
  FlushDenormals() : before_(Mode()) {
    if (!is_set()) SetMode((before_ & ~kFields) | kWanted);
  }
  ~FlushDenormals() {
    if (!is_set()) SetMode(before_);
  }

 private:
#if CAIRN_FLOAT_MODE_SSE
  using Word = unsigned;
  static Word Mode() { return _mm_getcsr(); }
  static void SetMode(Word mode) { _mm_setcsr(mode); }
  // zero for small results and for what is read that is small; how to round; what not to trap
  static constexpr Word kFields = 0x8040 | 0x6000 | 0x1f80;
  static constexpr Word kWanted = 0x8040 | 0x1f80;
#else
  /// FPCR, the register that says how numbers are rounded and flushed.
  using Word = std::uint64_t;
  static Word Mode() {
    Word mode;
    asm volatile("mrs %0, fpcr" : "=r"(mode));
    return mode;
  }
  // nothing that memory holds is computed on the wrong side of it
  static void SetMode(Word mode) { asm volatile("msr fpcr, %0" : : "r"(mode) : "memory"); }
  // zero for what is small; how to round; what to trap
  static constexpr Word kFields = Word{1} << 24 | Word{3} << 22 | 0x9f00;
  static constexpr Word kWanted = Word{1} << 24;
#endif
  bool is_set() const { return (before_ & kFields) == kWanted; }

  Word before_;
#else
  FlushDenormals() {}
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
};

}  // namespace cairn::simd
