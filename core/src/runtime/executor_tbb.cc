// SPDX-License-Identifier: MIT
#include "runtime/own_threads.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

namespace cairn {
namespace {

/// A job that oneTBB has. It may come to it late, when nobody wants it any more.
class Job {
 public:
  bool done() const { return state_.load(std::memory_order_acquire) == kDone; }

  /// @pre done()
  void Set(void (*work)(void*), void* what) {
    work_ = work;
    what_ = what;
    state_.store(kWaiting, std::memory_order_release);
  }
  /// Whoever comes first.
  void Run() {
    int waiting = kWaiting;
    if (!state_.compare_exchange_strong(waiting, kRunning, std::memory_order_acq_rel)) return;
    try {
      work_(what_);
    } catch (...) {
      // nobody is there to hear it
    }
    state_.store(kDone, std::memory_order_release);
    state_.notify_all();
  }
  /// What no thread came for is run here: by now it returns at once.
  void End() {
    Run();
    state_.wait(kRunning, std::memory_order_acquire);
  }

 private:
  enum State { kDone, kWaiting, kRunning };

  std::atomic<int> state_ = kDone;
  void (*work_)(void*) = nullptr;
  void* what_ = nullptr;
};

/// Jobs go to the arena that the caller is in: a game's own, or that of its thread. One of the
/// solver's would be one more for each solver, and oneTBB keeps them until a thread was in there.
class TbbExecutor final : public Executor {
 public:
  ~TbbExecutor() override {
    for (const std::shared_ptr<Job>& job : jobs_) job->End();
  }

  void Submit(void (*work)(void*), void* what) override {
    const std::shared_ptr<Job> job = Free();
    job->Set(work, what);
    tbb::this_task_arena::enqueue([job] { job->Run(); });
  }

 private:
  /// One that is done, and that oneTBB does not have any more.
  std::shared_ptr<Job> Free() {
    const auto free = std::find_if(jobs_.begin(), jobs_.end(), [](const auto& job) {
      return job->done() && job.use_count() == 1;
    });
    if (free != jobs_.end()) return *free;
    return jobs_.emplace_back(std::make_shared<Job>());
  }

  std::vector<std::shared_ptr<Job>> jobs_;
};

}  // namespace

int MostOwnThreads() {
  return static_cast<int>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

std::unique_ptr<Executor> MakeOwnExecutor(int) { return std::make_unique<TbbExecutor>(); }

}  // namespace cairn
