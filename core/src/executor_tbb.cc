// SPDX-License-Identifier: MIT
#include "executor_tbb.h"

#include <oneapi/tbb/task_arena.h>

namespace cairn {
namespace {

class TbbExecutor final : public Executor {
 public:
  explicit TbbExecutor(int threads) : arena_(threads) {}

  void Submit(void (*work)(void*), void* what) override {
    // oneTBB hands tasks over safely, but the thread sanitizer does not see into it
    arena_.enqueue([ work, what ]() __attribute__((no_sanitize("thread"))) { work(what); });
  }

 private:
  tbb::task_arena arena_;
};

}  // namespace

std::unique_ptr<Executor> MakeTbbExecutor(int threads) {
  return std::make_unique<TbbExecutor>(threads);
}

}  // namespace cairn
