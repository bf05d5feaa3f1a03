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
    case SpanKind::kTension:
      return "tension";
    case SpanKind::kWrite:
      return "write back";
  }
  return "";
}

SpanRecorder::SpanRecorder(int workers, int spans_of_worker)
    : threads_(std::clamp(workers, 1, kMostWorkers)) {
  for (OfThread& thread : threads_) thread.spans.resize(std::max(1, spans_of_worker));
}

void SpanRecorder::Clear() {
  for (OfThread& thread : threads_) {
    thread.size = 0;
    thread.dropped = 0;
  }
}

std::span<const Span> SpanRecorder::spans(int worker) const {
  const OfThread& thread = threads_[worker];
  return std::span(thread.spans).first(thread.size);
}

std::int64_t SpanRecorder::dropped() const {
  return std::accumulate(
      threads_.begin(), threads_.end(), std::int64_t{0},
      [](std::int64_t sum, const OfThread& thread) { return sum + thread.dropped; });
}

void SpanRecorder::Add(int worker, const Span& span) {
  if (worker < 0 || worker >= workers()) return;
  OfThread& thread = threads_[worker];
  if (thread.size > 0) {
    Span& last = thread.spans[thread.size - 1];
    if (last.label == span.label && (last.units > 0) == (span.units > 0) &&
        span.begin >= last.end && span.begin - last.end <= kSame) {
      last.end = span.end;
      last.units += span.units;
      return;
    }
  }
  if (thread.size == static_cast<int>(thread.spans.size())) {
    ++thread.dropped;
    return;
  }
  thread.spans[thread.size++] = span;
}

}  // namespace cairn
