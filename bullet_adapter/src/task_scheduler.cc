// SPDX-License-Identifier: MIT
#include "cairn/bullet/task_scheduler.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>
#include <utility>
#include <vector>

#include "cairn/detail/threads.h"

// Bullet counts the loops that run, for btThreadsAreRunning(). Its own schedulers declare these so.
void btPushThreadsAreRunning();
void btPopThreadsAreRunning();

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

constexpr int kMostThreads = static_cast<int>(BT_MAX_THREAD_COUNT);

/// Whether the Bullet in this process locks anything: a lock that two can have is none.
bool LocksWork() {
  btSpinMutex mutex;
  mutex.tryLock();
  return !mutex.tryLock();
}

std::string WhyAlone() {
  if (LocksWork()) return {};
  return "this Bullet was built without BT_THREADSAFE, so its loops stay on one thread; build one "
         "with `bash cmake/build-bullet-mt.sh`, or Bullet's own CMake option "
         "BULLET2_MULTITHREADING, and configure with -DBULLET_ROOT=<its prefix>";
}

/// Who is in a loop, by its number in Bullet. Numbers are handed out once for each thread of the
/// process, and again from 1 when there are no more: two threads that share one must not be in a
/// loop together, as what Bullet keeps for each thread is by number.
class Seats {
 public:
  bool Take(unsigned number) {
    return number < seats_.size() && !seats_[number].exchange(true, std::memory_order_acquire);
  }
  void Leave(unsigned number) { seats_[number].store(false, std::memory_order_release); }

 private:
  std::array<std::atomic<bool>, kMostThreads> seats_{};
};

/// Grains of a range, taken one by one by all who come. A part is somebody's share in the work,
/// whatever that comes to.
template <class DoGrain>
class Loop final : public detail::PartedWork {
 public:
  Loop(int grains, unsigned caller, Seats* seats, const DoGrain& do_grain)
      : grains_(grains), caller_(caller), seats_(*seats), do_grain_(do_grain) {}

  void Do(int) override {
    const unsigned number = btGetCurrentThreadIndex();
    if (number == caller_ && std::this_thread::get_id() == caller_thread_) return DoGrains();
    if (!seats_.Take(number)) return;
    DoGrains();
    seats_.Leave(number);
  }

 private:
  void DoGrains() {
    for (;;) {
      const int grain = next_.fetch_add(1, std::memory_order_relaxed);
      if (grain >= grains_) return;
      do_grain_(grain);
    }
  }

  const int grains_;
  const unsigned caller_;
  const std::thread::id caller_thread_ = std::this_thread::get_id();
  Seats& seats_;
  const DoGrain& do_grain_;
  std::atomic<int> next_{0};
};

/// Calls a function in the end, also where the body of a loop throws.
template <class Function>
class Finally {
 public:
  explicit Finally(Function function) : function_(std::move(function)) {}
  ~Finally() { function_(); }
  Finally(const Finally&) = delete;
  Finally& operator=(const Finally&) = delete;

 private:
  Function function_;
};

}  // namespace

struct TaskScheduler::Impl {
  void Use(int wanted) {
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    count = complaint.empty() ? std::clamp(wanted == 0 ? cores : wanted, 1, kMostThreads) : 1;
    threads.Follow(count, executor);
  }

  /// True if all grains were done by several; otherwise nothing was done.
  template <class DoGrain>
  bool Share(int grains, const DoGrain& do_grain) {
    if (count == 1 || grains <= 1 || busy.exchange(true, std::memory_order_acquire)) return false;
    const Finally no_longer_busy([this] { busy.store(false, std::memory_order_release); });
    const unsigned caller = btGetCurrentThreadIndex();
    if (!seats.Take(caller)) return false;
    const Finally leave([this, caller] { seats.Leave(caller); });
    btPushThreadsAreRunning();
    const Finally pop([] { btPopThreadsAreRunning(); });
    Loop<DoGrain> loop(grains, caller, &seats, do_grain);
    const int most = std::min(count, grains);
    const detail::AwakeHelpers awake(&threads, most);
    threads.Do(most, &loop);
    return true;
  }

  std::string complaint = WhyAlone();
  Executor* executor = nullptr;
  int count = 1;
  detail::Threads threads;
  Seats seats;
  std::atomic<bool> busy{false};
};

TaskScheduler::TaskScheduler(int threads, Executor* executor)
    : btITaskScheduler("cairn"), impl_(std::make_unique<Impl>()) {
  impl_->executor = executor;
  impl_->Use(threads);
}

TaskScheduler::~TaskScheduler() {
  if (btGetTaskScheduler() == this) btSetTaskScheduler(btGetSequentialTaskScheduler());
}

const std::string& TaskScheduler::complaint() const { return impl_->complaint; }
int TaskScheduler::threads() const { return impl_->count; }
void TaskScheduler::setNumThreads(int threads) { impl_->Use(std::max(1, threads)); }

void TaskScheduler::parallelFor(int begin, int end, int grain, const btIParallelForBody& body) {
  if (begin >= end) return;
  grain = std::max(1, grain);
  const bool shared = impl_->Share((end - begin + grain - 1) / grain, [&](int i) {
    const int first = begin + i * grain;
    body.forLoop(first, std::min(first + grain, end));
  });
  if (!shared) body.forLoop(begin, end);
}

btScalar TaskScheduler::parallelSum(int begin, int end, int grain, const btIParallelSumBody& body) {
  if (begin >= end) return 0;
  grain = std::max(1, grain);
  const auto of_grain = [&](int i) {
    const int first = begin + i * grain;
    return body.sumLoop(first, std::min(first + grain, end));
  };
  // grain by grain, whoever did them
  std::vector<btScalar> sums((end - begin + grain - 1) / grain);
  const auto keep = [&](int i) { sums[i] = of_grain(i); };
  const int grains = static_cast<int>(sums.size());
  if (!impl_->Share(grains, keep)) {
    for (int i = 0; i < grains; ++i) keep(i);
  }
  btScalar sum = 0;
  for (const btScalar part : sums) sum += part;
  return sum;
}

// Bullet's own would hand out numbers from 1 again, to threads of oneTBB that are not new.
void TaskScheduler::activate() { m_isActive = true; }
void TaskScheduler::deactivate() { m_isActive = false; }

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
