// SPDX-License-Identifier: MIT
// The record of who did what when: whole, in order, and without a trace in the results.
#include "cairn/detail/spans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <vector>

#include "cairn/solver.h"
#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

Span::Clock::time_point At(int microseconds) {
  return Span::Clock::time_point(std::chrono::microseconds(microseconds));
}

Span Sweep(int sweep, int begin, int end) {
  return {{SpanKind::kSweep, sweep}, At(begin), At(end)};
}

TEST(Spans, ThatGoOnWithTheSameLabelAreOne) {
  SpanRecorder recorder(1, 8);
  recorder.Add(0, Sweep(1, 0, 10));
  recorder.Add(0, Sweep(1, 11, 20));  // a microsecond later: the next claim of the same stage
  recorder.Add(0, Sweep(1, 30, 40));
  recorder.Add(0, Sweep(2, 41, 50));
  ASSERT_EQ(recorder.spans(0).size(), 3);
  EXPECT_EQ(recorder.spans(0)[0].end, At(20));
  EXPECT_EQ(recorder.spans(0)[1].begin, At(30));
  EXPECT_EQ(recorder.spans(0)[2].label, (SpanLabel{SpanKind::kSweep, 2}));
}

TEST(Spans, BeyondTheRoomForThemAreCounted) {
  SpanRecorder recorder(2, 3);
  for (int i = 0; i < 5; ++i) recorder.Add(1, Sweep(i, 10 * i, 10 * i + 1));
  recorder.Add(2, Sweep(0, 0, 1));  // a worker that was not announced
  EXPECT_EQ(recorder.spans(0).size(), 0);
  EXPECT_EQ(recorder.spans(1).size(), 3);
  EXPECT_EQ(recorder.dropped(), 2);
  recorder.Clear();
  EXPECT_EQ(recorder.spans(1).size(), 0);
  EXPECT_EQ(recorder.dropped(), 0);
}

/// Spans of a worker are apart or one within the other.
void ExpectNested(std::span<const Span> spans) {
  for (size_t i = 0; i < spans.size(); ++i) {
    EXPECT_LE(spans[i].begin, spans[i].end);
    for (size_t k = 0; k < i; ++k) {
      const bool apart = spans[k].end <= spans[i].begin || spans[i].end <= spans[k].begin;
      const bool within = spans[i].begin <= spans[k].begin && spans[k].end <= spans[i].end;
      EXPECT_TRUE(apart || within) << k << " and " << i;
    }
  }
}

int CountOf(std::span<const Span> spans, SpanKind kind) {
  return static_cast<int>(std::count_if(
      spans.begin(), spans.end(), [kind](const Span& span) { return span.label.kind == kind; }));
}

// The whole ones that follow where the state was moved on, and the moving itself, are sweeps too.
TEST(Spans, NameEverySweepASweep) {
  Settings settings = test::Coloured(9);
  settings.method = Method::kPgsSm;
  settings.k_sm = 0;
  SpanRecorder recorder(1, 1000);
  settings.tuning.spans = &recorder;
  ASSERT_TRUE(test::Solve(settings, test::Wall(6, 6)).report.ok());
  std::set<int> sweeps;
  bool set_up_again = false;
  for (const Span& span : recorder.spans(0)) {
    if (span.label.kind == SpanKind::kSetUp) set_up_again = !sweeps.empty();
    if (span.label.kind != SpanKind::kSweep) continue;
    EXPECT_FALSE(set_up_again) << "sweep " << span.label.number;
    sweeps.insert(span.label.number);
  }
  EXPECT_EQ(sweeps, (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(Spans, AreNotTakenDownByASolveThatHasNoRecorder) {
  Settings settings = test::Coloured(3);
  settings.threads = 4;
  const test::Scene large = test::Wall(40, 20), small = test::Wall(3, 3);
  Solver solver(settings);
  const auto solve = [&solver](const test::Scene& scene) {
    std::vector<double> impulses(scene.rows.size());
    std::vector<Velocity> velocities(scene.bodies.size());
    ASSERT_TRUE(solver.Solve(scene.problem(), {.rows = impulses}, velocities).ok());
  };
  SpanRecorder recorder(4, 10000);
  solver.settings().tuning.spans = &recorder;
  solve(large);
  recorder.Clear();
  solver.settings().tuning.spans = nullptr;
  solve(small);
  EXPECT_EQ(recorder.spans(0).size(), 0);
  // and the other way round
  solve(large);
  solver.settings().tuning.spans = &recorder;
  solve(small);
  EXPECT_GT(recorder.spans(0).size(), 0);
}

TEST(Spans, OfASolveAreThoseOfItsPhasesAndChangeNoBit) {
  const test::Scene scene = test::Wall(40, 20);
  for (const int threads : {1, 3}) {
    Settings settings = test::ColouredSteps(15);
    settings.threads = threads;
    const std::vector<test::Solution> expected = test::Play(settings, scene, 3);
    SpanRecorder recorder(threads, 100000);
    settings.tuning.spans = &recorder;
    EXPECT_TRUE(test::SameBits(test::Play(settings, scene, 3), expected)) << threads;

    EXPECT_EQ(recorder.dropped(), 0);
    for (const SpanKind kind : {SpanKind::kSetUp, SpanKind::kSweep, SpanKind::kMeasure,
                                SpanKind::kStep, SpanKind::kFactorise, SpanKind::kResults}) {
      EXPECT_GT(CountOf(recorder.spans(0), kind), 0) << Describe(kind);
    }
    EXPECT_EQ(CountOf(recorder.spans(0), SpanKind::kSetUp) >= 3, true);
    for (int worker = 0; worker < threads; ++worker) {
      const auto spans = recorder.spans(worker);
      ExpectNested(spans.first(std::min<size_t>(spans.size(), 2000)));
      if (worker > 0) {
        EXPECT_EQ(CountOf(spans, SpanKind::kWait), 0);
      }
    }
  }
}

}  // namespace
}  // namespace cairn
