// SPDX-License-Identifier: MIT
// In place of executor_tbb.cc where Cairn is built without oneTBB (CAIRN_TBB=OFF).
#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "runtime/own_threads.h"

namespace cairn {
namespace {

/// Threads of its own, started by the first task.
class ThreadExecutor final : public Executor {
 public:
  explicit ThreadExecutor(int threads) : most_(threads - 1) {}
  /// Tasks that no thread came for are run here: by now they return at once.
  ~ThreadExecutor() override {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
    for (const Task& task : tasks_) task.work(task.what);
  }

  void Submit(void (*work)(void*), void* what) override {
    if (static_cast<int>(threads_.size()) < most_) AddThread();
    {
      const std::lock_guard lock(mutex_);
      tasks_.push_back({work, what});
    }
    wake_.notify_one();
  }

 private:
  void AddThread() {
    try {
      threads_.emplace_back([this] { Work(); });
    } catch (const std::system_error&) {
      // there are no more to be had: those that there are, or the caller, do the work
      most_ = static_cast<int>(threads_.size());
    }
  }

  struct Task {
    void (*work)(void*);
    void* what;
  };

  void Work() {
    for (std::unique_lock lock(mutex_);;) {
      wake_.wait(lock, [this] { return ends_ || !tasks_.empty(); });
      if (ends_) return;
      const Task task = tasks_.back();
      tasks_.pop_back();
      lock.unlock();
      task.work(task.what);
      lock.lock();
    }
  }

  int most_;
  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Task> tasks_;
  bool ends_ = false;
};

}  // namespace

int MostOwnThreads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

std::unique_ptr<Executor> MakeOwnExecutor(int threads) {
  return std::make_unique<ThreadExecutor>(threads);
}

}  // namespace cairn
