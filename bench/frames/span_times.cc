// SPDX-License-Identifier: MIT
#include "frames/span_times.h"

#include <chrono>
#include <numeric>

namespace cairn::frames {

SpanTimes::SpanTimes(std::span<const Span> spans) {
  Span::Clock::time_point outer = Span::Clock::time_point::max();
  // a span comes after those that it contains
  for (size_t i = spans.size(); i-- > 0;) {
    const Span& span = spans[i];
    if (span.begin >= outer) continue;
    outer = span.begin;
    times_[static_cast<size_t>(span.label.kind)] +=
        std::chrono::duration<double, std::micro>(span.end - span.begin).count();
  }
}

double SpanTimes::together() const { return std::accumulate(times_.begin(), times_.end(), 0.0); }

}  // namespace cairn::frames
