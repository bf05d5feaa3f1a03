// SPDX-License-Identifier: MIT
#include "runtime/own_threads.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

namespace cairn {
namespace {

/// A job that oneTBB has. It may come to it late, when nobody wants it any more.
class Job {
 public:
  /// Done, and oneTBB does not have it any more.
  bool free() const { return owners_.load(std::memory_order_acquire) == 1; }

  /// For oneTBB, too, which calls RunAndRelease(). @pre free()
  void Set(void (*work)(void*), void* what) {
    work_ = work;
    what_ = what;
    owners_.fetch_add(1, std::memory_order_relaxed);
    state_.store(kWaiting, std::memory_order_release);
  }
  /// oneTBB did not take it.
  void TakeBack() {
    state_.store(kDone, std::memory_order_relaxed);
    Release();
  }
  void RunAndRelease() {
    Run();
    Release();
  }
  /// What no thread came for is run here: by now it returns at once.
  void End() {
    Run();
    state_.wait(kRunning, std::memory_order_acquire);
    Release();
  }

 private:
  friend class Jobs;
  enum State { kDone, kWaiting, kRunning };

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
  void Release();

  std::atomic<int> owners_ = 0, state_ = kDone;
  void (*work_)(void*) = nullptr;
  void* what_ = nullptr;
  Job* next_ = nullptr;  ///< that nobody has
};

/// All jobs of the process, used again and never freed: oneTBB drops what it has when the process
/// ends without a word.
class Jobs {
 public:
  static Jobs& OfProcess() {
    static Jobs* const jobs = new Jobs;
    return *jobs;
  }

  Job* Take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    Job* job = first_;
    if (job == nullptr) {
      job = &all_.emplace_back();
    } else {
      first_ = job->next_;
    }
    job->owners_.store(1, std::memory_order_relaxed);
    return job;
  }
  void Give(Job* job) {
    const std::lock_guard<std::mutex> lock(mutex_);
    job->next_ = first_;
    first_ = job;
  }

 private:
  std::mutex mutex_;
  std::deque<Job> all_;
  Job* first_ = nullptr;  ///< that nobody has
};

void Job::Release() {
  if (owners_.fetch_sub(1, std::memory_order_acq_rel) == 1) Jobs::OfProcess().Give(this);
}

/// Jobs go to the arena that the caller is in: a game's own, or that of its thread. One of the
/// solver's would be one more for each solver, and oneTBB keeps them until a thread was in there.
class TbbExecutor final : public Executor {
 public:
  ~TbbExecutor() override {
    for (Job* const job : jobs_) job->End();
  }

  void Submit(void (*work)(void*), void* what) override {
    Job* const job = Free();
    job->Set(work, what);
    try {
      tbb::this_task_arena::enqueue([job] { job->RunAndRelease(); });
    } catch (...) {
      job->TakeBack();  // whoever asked takes back what it is about
      throw;
    }
  }

 private:
  Job* Free() {
    const auto free =
        std::find_if(jobs_.begin(), jobs_.end(), [](Job* job) { return job->free(); });
    if (free != jobs_.end()) return *free;
    jobs_.reserve(jobs_.size() + 1);  // where there is no memory nothing is lost
    jobs_.push_back(Jobs::OfProcess().Take());
    return jobs_.back();
  }

  std::vector<Job*> jobs_;
};

}  // namespace

int MostOwnThreads() {
  return static_cast<int>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

std::unique_ptr<Executor> MakeOwnExecutor(int) { return std::make_unique<TbbExecutor>(); }

}  // namespace cairn
