// SPDX-License-Identifier: MIT
#include "runtime/own_threads.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

namespace cairn {
namespace {

class TbbExecutor final : public Executor {
 public:
  explicit TbbExecutor(int threads) : arena_(threads) {}
  /// Tasks that no thread came for are run here: by now they return at once.
  ~TbbExecutor() override {
    arena_.execute([this] { tasks_->wait(); });
  }

  void Submit(void (*work)(void*), void* what) override {
    arena_.execute([&] { tasks_->run([work, what] { work(what); }); });
  }

 private:
  tbb::task_arena arena_;
  // its destructor may throw, where ours may not
  std::unique_ptr<tbb::task_group> tasks_ = std::make_unique<tbb::task_group>();
};

}  // namespace

int MostOwnThreads() {
  return static_cast<int>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

std::unique_ptr<Executor> MakeOwnExecutor(int threads) {
  return std::make_unique<TbbExecutor>(threads);
}

}  // namespace cairn
