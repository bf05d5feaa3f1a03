// SPDX-License-Identifier: MIT
// Threads that claim units of stages: every unit once, no stage before the last, whoever comes.
#include "runtime/crew.h"

#include <gtest/gtest.h>
#if defined(__linux__)
#include <unistd.h>
#endif

#include <atomic>
#include <fstream>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "cairn/detail/threads.h"
#include "runtime/in_parts.h"

namespace cairn {
namespace {

/// Counts what is done, and whether anything is done too early.
class Counted final : public StagedWork {
 public:
  explicit Counted(std::vector<int> units)
      : units_(std::move(units)),
        runs_(std::accumulate(units_.begin(), units_.end(), 0)),
        done_(units_.size()) {}

  int stages() const override { return static_cast<int>(units_.size()); }
  int units(int stage) const override { return units_[stage]; }
  void Do(int stage, int unit) override {
    for (int before = 0; before < stage; ++before) {
      if (done_[before] != units_[before]) early_ = true;
    }
    ++runs_[std::accumulate(units_.begin(), units_.begin() + stage, unit)];
    ++done_[stage];
  }
  bool GoOn(int stage) override { return stage < end_; }

  void ExpectDoneOnce(int stages) const {
    EXPECT_FALSE(early_);
    const int end = std::accumulate(units_.begin(), units_.begin() + stages, 0);
    for (int i = 0; i < static_cast<int>(runs_.size()); ++i) EXPECT_EQ(runs_[i], i < end ? 1 : 0);
  }
  void EndBefore(int stage) { end_ = stage; }

 private:
  std::vector<int> units_;
  std::vector<std::atomic<int>> runs_, done_;
  std::atomic<bool> early_ = false;
  int end_ = 1 << 30;
};

const std::vector<int> kStages = {7, 0, 1, 40, 3, 700};

TEST(Crew, DoesEveryUnitOnceAndNoStageBeforeTheLast) {
  for (const int threads : {1, 2, 3, 5, 8}) {
    Crew crew(threads);
    for (int repetition = 0; repetition < 200; ++repetition) {
      Counted work(kStages);
      crew.Run(&work);
      work.ExpectDoneOnce(6);
    }
  }
}

TEST(Crew, OfOneIsAloneAndDoesAllInOrder) {
  Crew crew(1);
  EXPECT_TRUE(crew.alone());
  EXPECT_FALSE(Crew(2).alone());
  SpanRecorder recorder(1, 16);
  crew.RecordTo(&recorder);
  std::vector<int> done;
  ForUnits(5, &crew, [&done](int unit) { done.push_back(unit); }, {SpanKind::kSweep, 3, 1});
  EXPECT_EQ(done, (std::vector<int>{0, 1, 2, 3, 4}));
  ASSERT_EQ(recorder.spans(0).size(), 1u);
  EXPECT_EQ(recorder.spans(0)[0].label, (SpanLabel{SpanKind::kSweep, 3, 1}));
  EXPECT_EQ(recorder.spans(0)[0].units, 5);
}

TEST(Crew, ThrowsWhatAUnitThrewWhenNobodyIsAtWork) {
  for (const int threads : {1, 2, 4}) {
    Crew crew(threads);
    for (int repetition = 0; repetition < 200; ++repetition) {
      std::atomic<int> at_work = 0;
      const bool all_throw = repetition % 2 == 0;
      const auto unit = [&](int i) {
        ++at_work;
        for (int spin = 0; spin < 200; ++spin) at_work.load();
        --at_work;
        if (all_throw || i == 17) throw std::runtime_error("unit");
      };
      EXPECT_THROW(ForUnits(40, &crew, unit), std::runtime_error);
      EXPECT_EQ(at_work, 0);
      Counted work(kStages);
      crew.Run(&work);
      work.ExpectDoneOnce(6);
    }
  }
}

TEST(Crew, DoesManyWorksOfOneShift) {
  Crew crew(3);
  for (int shift = 0; shift < 50; ++shift) {
    crew.Call();
    for (int repetition = 0; repetition < 20; ++repetition) {
      Counted work(kStages);
      crew.Run(&work);
      work.ExpectDoneOnce(6);
    }
    crew.Dismiss();
  }
}

/// A job system that never has time, and one that starts a thread for each task.
class NoThreads final : public Executor {
 public:
  void Submit(void (*work)(void*), void* what) override { tasks.emplace_back(work, what); }
  std::vector<std::pair<void (*)(void*), void*>> tasks;
};
class OwnThreads final : public Executor {
 public:
  ~OwnThreads() override {
    for (std::thread& thread : threads) thread.join();
  }
  void Submit(void (*work)(void*), void* what) override { threads.emplace_back(work, what); }
  std::vector<std::thread> threads;
};

TEST(Crew, AsksForAsManyAsTheWorkIsWorth) {
  NoThreads executor;
  {
    Crew crew(8, &executor);
    EXPECT_EQ(crew.threads(), 1);
    crew.Call(3);
    EXPECT_EQ(crew.threads(), 3);
    crew.Dismiss();
    EXPECT_EQ(crew.threads(), 1);
    crew.Call(1);
    EXPECT_FALSE(crew.called());
  }
  EXPECT_EQ(executor.tasks.size(), 2u);
  for (const auto& [work, what] : executor.tasks) work(what);
}

TEST(Crew, HasNoMoreThreadsOfOneTbbThanThereAreCores) {
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  testing::internal::CaptureStderr();
  {
    Crew crew(1024);
    crew.Call();
    EXPECT_LE(crew.threads(), cores);
    Counted work(kStages);
    crew.Run(&work);
    work.ExpectDoneOnce(6);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Threads, DoEachPartOnceAndStayForTheSolver) {
  OwnThreads executor;
  detail::Threads threads;
  threads.Follow(3, &executor);
  for (const int most : {1, 2, 3}) {
    const detail::AwakeHelpers awake(&threads, most);
    EXPECT_EQ(threads.several(), most > 1);
    std::vector<std::atomic<int>> done(1000);
    threads.For(1000, 7, [&](int first, int count) {
      for (int i = first; i < first + count; ++i) done[i].fetch_add(1);
    });
    for (const std::atomic<int>& times : done) ASSERT_EQ(times, 1);
  }
  EXPECT_FALSE(threads.several());
}

TEST(Threads, AreAsManyAsTheRowsAreWorth) {
  EXPECT_EQ(detail::ThreadsFor(0, 8), 1);
  EXPECT_EQ(detail::ThreadsFor(4095, 8), 1);
  EXPECT_EQ(detail::ThreadsFor(4096, 8), 2);
  EXPECT_EQ(detail::ThreadsFor(4096, 1), 1);
  EXPECT_EQ(detail::ThreadsFor(1 << 20, 8), 8);
}

// Sanitizers keep memory of their own for each.
#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__clang__)
/// Memory of this process that is in use [bytes].
double Resident() {
  std::ifstream file("/proc/self/statm");
  double size = 0, resident = 0;
  file >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

// Each had an arena of oneTBB's, which was kept until a thread had been in it.
TEST(Crew, OneAfterTheOtherTakesNoMoreMemory) {
  const auto live = [](int crews) {
    for (int i = 0; i < crews; ++i) {
      Crew crew(2);
      Counted work({4});
      crew.Run(&work);
    }
  };
  live(200);
  const double before = Resident();
  live(4000);
  EXPECT_LT(Resident() - before, 4e6);
}
#endif

TEST(Crew, EndsBetweenStagesWhereItIsToldTo) {
  for (const int threads : {1, 4}) {
    Crew crew(threads);
    Counted work(kStages);
    work.EndBefore(4);
    crew.Run(&work);
    work.ExpectDoneOnce(4);
  }
}

TEST(Crew, DoesNothingWhereThereIsNothing) {
  Crew crew(3);
  Counted work({});
  crew.Run(&work);
  work.ExpectDoneOnce(0);
}

TEST(Crew, FinishesAloneWhereNobodyComes) {
  NoThreads executor;
  {
    Crew crew(4, &executor);
    for (int repetition = 0; repetition < 3; ++repetition) {
      Counted work(kStages);
      crew.Run(&work);
      work.ExpectDoneOnce(6);
    }
  }
  // asked once, not once a run, and those that come when all is over find nothing to do
  EXPECT_EQ(executor.tasks.size(), 3u);
  for (const auto& [work, what] : executor.tasks) work(what);
}

TEST(Crew, WorksWithThreadsOfTheHost) {
  OwnThreads executor;
  Crew crew(3, &executor);
  for (int repetition = 0; repetition < 20; ++repetition) {
    Counted work(kStages);
    crew.Run(&work);
    work.ExpectDoneOnce(6);
  }
  EXPECT_GE(executor.threads.size(), 2u);
}

}  // namespace
}  // namespace cairn
