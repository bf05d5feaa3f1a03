// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "cairn/detail/spans.h"

namespace cairn::cli {

/// A stretch of time of a thread; stretches of a thread contain others or are apart.
struct TimelineSpan {
  std::string name;
  std::string kind;             ///< Names of a kind are drawn alike.
  double begin = 0, end = 0;    ///< Since the frame began [ms].
  int sweep = -1, colour = -1;  ///< Of a sweep.
};

/// What threads did in a frame.
struct Timeline {
  int frame = -1;                                  ///< None if negative.
  double time = 0;                                 ///< In the solver [ms].
  std::vector<std::vector<TimelineSpan>> workers;  ///< The first is the thread of the world.
  std::int64_t dropped = 0;                        ///< Spans that there was no room for.
};

/// Records what the threads of a world do in a frame: the zones of Bullet's profiler, Cairn's
/// spans, and what the tool itself does inside.
class TimelineRecorder {
 public:
  explicit TimelineRecorder(int workers);

  /// For Tuning::spans.
  SpanRecorder* spans() { return &spans_; }

  /// A frame begins, on this thread. One recorder at a time.
  void Begin();
  void End();
  /// Notes a stretch that is the tool's own, not a solver's. Within Begin() and End().
  void AddOwn(const char* name, Span::Clock::time_point begin);
  /// What happened between the last Begin() and End().
  Timeline Read(int frame, double time) const;

  /// Whether the Bullet that the program runs with calls its profiler's hooks. Known after the
  /// first frame.
  bool bullet_has_zones() const { return bullet_has_zones_; }

 private:
  struct Zone {
    const char* name;
    Span::Clock::time_point begin, end;
    bool own;
  };
  static void Enter(const char* name);
  static void Leave();

  SpanRecorder spans_;
  std::vector<Zone> zones_;
  std::vector<size_t> open_;  ///< zones that have not ended, the innermost last
  std::int64_t dropped_ = 0;
  Span::Clock::time_point begin_;
  bool bullet_has_zones_ = false;
};

}  // namespace cairn::cli
