// SPDX-License-Identifier: MIT
// In place of executor_tbb.cc where Cairn is built without oneTBB (CAIRN_TBB=OFF).
#include <algorithm>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "runtime/own_threads.h"

#ifdef __unix__
#include <unistd.h>
#endif

namespace cairn {
namespace {

/// Of the process; a child that fork() made has another one.
long ProcessId() {
#ifdef __unix__
  return static_cast<long>(getpid());
#else
  return 0;
#endif
}

/// Threads of its own, started by the first task. A process that fork() made has none of them: the
/// caller does their work.
class ThreadExecutor final : public Executor {
 public:
  explicit ThreadExecutor(int threads) : most_(threads - 1) {}
  /// Tasks that no thread came for are run here: by now they return at once.
  ~ThreadExecutor() override {
    if (ProcessId() != process_) {
      // nobody is there to be joined, or to let go of what it waits for
      for (std::thread& thread : threads_) thread.detach();
      static_cast<void>(shared_.release());
      for (const Task& task : left_) task.work(task.what);
      return;
    }
    {
      const std::lock_guard lock(shared_->mutex);
      shared_->ends = true;
    }
    shared_->wake.notify_all();
    for (std::thread& thread : threads_) thread.join();
    for (const Task& task : shared_->tasks) task.work(task.what);
  }

  void Submit(void (*work)(void*), void* what) override {
    if (ProcessId() != process_) return left_.push_back({work, what});
    if (static_cast<int>(threads_.size()) < most_) AddThread();
    {
      const std::lock_guard lock(shared_->mutex);
      shared_->tasks.push_back({work, what});
    }
    shared_->wake.notify_one();
  }

 private:
  void AddThread() {
    try {
      threads_.emplace_back([shared = shared_.get()] { Work(shared); });
    } catch (const std::system_error&) {
      // there are no more to be had: those that there are, or the caller, do the work
      most_ = static_cast<int>(threads_.size());
    }
  }

  struct Task {
    void (*work)(void*);
    void* what;
  };

  struct Shared {
    std::mutex mutex;
    std::condition_variable wake;
    std::vector<Task> tasks;
    bool ends = false;
  };

  static void Work(Shared* shared) {
    for (std::unique_lock lock(shared->mutex);;) {
      shared->wake.wait(lock, [shared] { return shared->ends || !shared->tasks.empty(); });
      if (shared->ends) return;
      const Task task = shared->tasks.back();
      shared->tasks.pop_back();
      lock.unlock();
      task.work(task.what);
      lock.lock();
    }
  }

  const long process_ = ProcessId();
  int most_;
  std::vector<std::thread> threads_;
  std::unique_ptr<Shared> shared_ = std::make_unique<Shared>();
  std::vector<Task> left_;  ///< those of another process than threads_
};

}  // namespace

int MostOwnThreads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

std::unique_ptr<Executor> MakeOwnExecutor(int threads) {
  return std::make_unique<ThreadExecutor>(threads);
}

}  // namespace cairn
