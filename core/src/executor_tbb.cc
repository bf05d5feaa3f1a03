// SPDX-License-Identifier: MIT
#include "executor_tbb.h"

#include <atomic>
#include <thread>
#include <vector>

#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

namespace cairn {
namespace {

/// Looks at a counter this often before giving the core to somebody else.
constexpr int kSpins = 4000;

/// A stage that is being worked on, alone on its cache lines.
struct alignas(128) Stage {
  std::atomic<int> claimed{0}, done{0};
};

/// What the threads share during one Run(). Published by `ready`: oneTBB hands tasks over safely,
/// but the thread sanitizer does not see into it, nor into the task itself.
struct Job {
  std::span<const int> blocks_of_stage;
  const std::function<void(int, int)>* work;
  std::vector<Stage> stages;
  std::atomic<bool> ready{false};
};

void Attend(Job* job) {
  if (!job->ready.load(std::memory_order_acquire)) return;
  for (size_t s = 0; s < job->blocks_of_stage.size(); ++s) {
    Stage& stage = job->stages[s];
    const int blocks = job->blocks_of_stage[s];
    for (int block; (block = stage.claimed.fetch_add(1, std::memory_order_relaxed)) < blocks;) {
      (*job->work)(static_cast<int>(s), block);
      stage.done.fetch_add(1, std::memory_order_release);
    }
    // what is claimed is being worked on by a running thread: this wait ends
    for (int spin = 0; stage.done.load(std::memory_order_acquire) < blocks; ++spin) {
      if (spin > kSpins) std::this_thread::yield();
    }
  }
}

}  // namespace

struct Crew::Impl {
  int threads;
  tbb::task_arena arena;
};

Crew::Crew(int threads) : impl_(std::make_unique<Impl>()) {
  impl_->threads = threads;
  if (threads > 1) impl_->arena.initialize(threads);
}
Crew::~Crew() = default;
Crew::Crew(Crew&&) noexcept = default;
Crew& Crew::operator=(Crew&&) noexcept = default;

int Crew::threads() const { return impl_->threads; }

void Crew::Run(std::span<const int> blocks_of_stage, const std::function<void(int, int)>& work) {
  if (impl_->threads == 1) {
    for (size_t s = 0; s < blocks_of_stage.size(); ++s) {
      for (int block = 0; block < blocks_of_stage[s]; ++block) work(static_cast<int>(s), block);
    }
    return;
  }
  Job job{blocks_of_stage, &work, std::vector<Stage>(blocks_of_stage.size())};
  job.ready.store(true, std::memory_order_release);
  impl_->arena.execute([this, &job] {
    tbb::task_group helpers;
    for (int t = 1; t < impl_->threads; ++t) {
      helpers.run([shared = &job]() __attribute__((no_sanitize("thread"))) { Attend(shared); });
    }
    Attend(&job);
    helpers.wait();
  });
}

}  // namespace cairn
