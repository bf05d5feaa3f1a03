// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include "cairn/detail/spans.h"

namespace cairn::frames {

/// Wall time of a thread by what it was busy with [us]; of spans that contain others only the outer
/// ones count, less waits and tension in them.
class SpanTimes {
 public:
  SpanTimes() = default;
  explicit SpanTimes(std::span<const Span> spans);

  double of(SpanKind kind) const { return times_[static_cast<size_t>(kind)]; }
  double together() const;

 private:
  std::array<double, kSpanKinds> times_{};
};

}  // namespace cairn::frames
