// SPDX-License-Identifier: MIT
#include "frames/span_times.h"

#include <chrono>
#include <numeric>

namespace cairn::frames {

SpanTimes::SpanTimes(std::span<const Span> spans) {
  Span::Clock::time_point outer = Span::Clock::time_point::max();
  size_t outer_kind = 0;
  // a span comes after those that it contains
  for (size_t i = spans.size(); i-- > 0;) {
    const Span& span = spans[i];
    const auto kind = static_cast<size_t>(span.label.kind);
    const double time = std::chrono::duration<double, std::micro>(span.end - span.begin).count();
    if (span.begin >= outer) {
      // told apart from what they are part of
      if (span.label.kind != SpanKind::kTension && span.label.kind != SpanKind::kWait) continue;
      times_[outer_kind] -= time;
      times_[kind] += time;
      continue;
    }
    outer = span.begin;
    outer_kind = kind;
    times_[kind] += time;
  }
}

double SpanTimes::together() const { return std::accumulate(times_.begin(), times_.end(), 0.0); }

}  // namespace cairn::frames
