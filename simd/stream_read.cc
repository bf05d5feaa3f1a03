// SPDX-License-Identifier: MIT
#include "simd/stream_read.h"

#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/stream_read.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline float ReadLines(const Line* lines, std::size_t count) {
  const hn::CappedTag<float, kLanes> d;
  constexpr std::size_t kWidth = hn::MaxLanes(d);
  constexpr std::size_t kSums = 8;  // independent, to hide how long an addition takes
  const float* const from = lines->lane;
  const std::size_t size = count * kLanes, step = kSums * kWidth;
  auto s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
  std::size_t i = 0;
  for (; i + step <= size; i += step) {
    s0 = hn::Add(s0, hn::Load(d, from + i));
    s1 = hn::Add(s1, hn::Load(d, from + i + kWidth));
    s2 = hn::Add(s2, hn::Load(d, from + i + 2 * kWidth));
    s3 = hn::Add(s3, hn::Load(d, from + i + 3 * kWidth));
    s4 = hn::Add(s4, hn::Load(d, from + i + 4 * kWidth));
    s5 = hn::Add(s5, hn::Load(d, from + i + 5 * kWidth));
    s6 = hn::Add(s6, hn::Load(d, from + i + 6 * kWidth));
    s7 = hn::Add(s7, hn::Load(d, from + i + 7 * kWidth));
  }
  for (; i < size; i += kWidth) s0 = hn::Add(s0, hn::Load(d, from + i));
  const auto lo = hn::Add(hn::Add(s0, s1), hn::Add(s2, s3));
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(lo, hn::Add(hn::Add(s4, s5), hn::Add(s6, s7)))));
}

}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
#include "simd/dispatch-inl.h"

namespace cairn::simd {
namespace {

float ReadLines(const Line* lines, std::size_t count) {
  std::array<float, kLanes> sums = {};
  for (std::size_t i = 0; i < count; ++i) {
    for (int lane = 0; lane < kLanes; ++lane) sums[lane] += lines[i].lane[lane];
  }
  float sum = 0;
  for (const float part : sums) sum += part;
  return sum;
}

}  // namespace

float StreamRead(Target target, const Line* lines, std::size_t count) {
  return CAIRN_DISPATCH_OR(target, ReadLines, cairn::simd::ReadLines)(lines, count);
}

}  // namespace cairn::simd
#endif
