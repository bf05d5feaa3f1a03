// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <chrono>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace cairn {

/// What a thread was busy with.
enum class SpanKind : std::uint8_t {
  kRead,       ///< The adapter of an engine makes the problem.
  kSetUp,      ///< Pairs, colours, blocks, numbers.
  kSweep,      ///< Of a colour, or all of one: SpanLabel::number is the sweep, part the colour.
  kMeasure,    ///< Residuals.
  kGuard,      ///< What impulses are worth, after the first sweeps and after the last.
  kStep,       ///< A subspace step, factorisation included.
  kFactorise,  ///< Cholesky; number is the front.
  kWait,       ///< For units of work that another thread has claimed.
  kResults,    ///< Impulses and velocities out of the blocks.
  kTension,    ///< Geometric stiffness, before and after.
  kWrite,      ///< The adapter writes back.
};
inline constexpr int kSpanKinds = static_cast<int>(SpanKind::kWrite) + 1;

/// Two words at most.
std::string_view Describe(SpanKind kind);

struct SpanLabel {
  SpanKind kind = SpanKind::kSetUp;
  int number = 0, part = 0;

  friend bool operator==(const SpanLabel&, const SpanLabel&) = default;
};

struct Span {
  using Clock = std::chrono::steady_clock;

  SpanLabel label;
  Clock::time_point begin, end;
  /// Of a stage that threads share: so many of its units were done. 0: of no such stage.
  int units = 0;
};

/// Takes down what the threads of a Solve() did when (Tuning::spans): for timelines. The results
/// of a Solve() are the same with it; it reads the clock twice for each unit of work that a thread
/// claims.
///
/// Worker 0 is the caller of Solve(). Memory is allocated once; spans beyond it are dropped.
class SpanRecorder {
 public:
  static constexpr int kMostWorkers = 64;

  /// @pre 1 <= workers <= kMostWorkers, spans_of_worker >= 1
  SpanRecorder(int workers, int spans_of_worker);

  /// Forgets all spans. Not during a Solve().
  void Clear();
  /// In order of their ends. Spans contain others or are apart.
  std::span<const Span> spans(int worker) const;
  int workers() const { return static_cast<int>(threads_.size()); }
  /// Spans of all workers that there was no room for.
  std::int64_t dropped() const;

  /// A span that begins where the last one of that worker ended, with the same label, becomes part
  /// of it. Each worker adds its own; workers that were not announced are not recorded.
  void Add(int worker, const Span& span);

 private:
  struct alignas(64) OfThread {
    std::vector<Span> spans;  ///< all that there is room for
    int size = 0;
    std::int64_t dropped = 0;
  };
  std::vector<OfThread> threads_;
};

/// Records a span from its construction to its destruction. Without a recorder it does nothing.
class SpanClock {
 public:
  SpanClock(SpanRecorder* recorder, int worker, SpanLabel label, int units = 0)
      : recorder_(recorder), worker_(worker) {
    if (recorder_ != nullptr) span_ = {label, Span::Clock::now(), {}, units};
  }
  ~SpanClock() {
    if (recorder_ == nullptr) return;
    span_.end = Span::Clock::now();
    recorder_->Add(worker_, span_);
  }
  SpanClock(const SpanClock&) = delete;
  SpanClock& operator=(const SpanClock&) = delete;

 private:
  SpanRecorder* recorder_;
  int worker_;
  Span span_;
};

}  // namespace cairn
