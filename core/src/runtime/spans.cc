// SPDX-License-Identifier: MIT
#include "cairn/detail/spans.h"

#include <algorithm>
#include <numeric>

namespace cairn {
namespace {

/// Spans of the same label that are closer belong together: between two claims of a stage.
constexpr std::chrono::nanoseconds kSame{1000};

}  // namespace

std::string_view Describe(SpanKind kind) {
  switch (kind) {
    case SpanKind::kRead:
      return "read contacts";
    case SpanKind::kSetUp:
      return "set-up";
    case SpanKind::kSweep:
      return "sweep";
    case SpanKind::kMeasure:
      return "residual";
    case SpanKind::kGuard:
      return "guards";
    case SpanKind::kStep:
      return "subspace step";
    case SpanKind::kFactorise:
      return "factorise";
    case SpanKind::kWait:
      return "wait";
    case SpanKind::kResults:
      return "results";
    case SpanKind::kWrite:
      return "write back";
  }
  return "";
}

SpanRecorder::SpanRecorder(int workers, int spans_of_worker)
    : lanes_(std::clamp(workers, 1, kMostWorkers)) {
  for (Lane& lane : lanes_) lane.spans.resize(std::max(1, spans_of_worker));
}

void SpanRecorder::Clear() {
  for (Lane& lane : lanes_) {
    lane.size = 0;
    lane.dropped = 0;
  }
}

std::span<const Span> SpanRecorder::spans(int worker) const {
  const Lane& lane = lanes_[worker];
  return std::span(lane.spans).first(lane.size);
}

std::int64_t SpanRecorder::dropped() const {
  return std::accumulate(lanes_.begin(), lanes_.end(), std::int64_t{0},
                         [](std::int64_t sum, const Lane& lane) { return sum + lane.dropped; });
}

void SpanRecorder::Add(int worker, const Span& span) {
  if (worker < 0 || worker >= workers()) return;
  Lane& lane = lanes_[worker];
  if (lane.size > 0) {
    Span& last = lane.spans[lane.size - 1];
    if (last.label == span.label && (last.units > 0) == (span.units > 0) &&
        span.begin >= last.end && span.begin - last.end <= kSame) {
      last.end = span.end;
      last.units += span.units;
      return;
    }
  }
  if (lane.size == static_cast<int>(lane.spans.size())) {
    ++lane.dropped;
    return;
  }
  lane.spans[lane.size++] = span;
}

}  // namespace cairn
