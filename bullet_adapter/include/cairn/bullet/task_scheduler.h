// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <LinearMath/btThreads.h>

#include <memory>
#include <string>

#include "cairn/bullet/precision.h"
#include "cairn/executor.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// The threads of Bullet's own loops (btParallelFor), where those of the solver come from: oneTBB
/// or an Executor of the host. Give it to btSetTaskScheduler() on the thread that steps the world,
/// before anything of Bullet named "Mt" is made; it must outlive all of that.
///
/// Most Bullets that are installed are built without locks (BT_THREADSAFE), Debian's among them:
/// more than one thread in them would race. In such a Bullet it stays on one thread, and
/// complaint() says what to do.
///
/// A loop in a loop is done by the thread that came to it, and so is a loop of a world that is
/// stepped while another one has the threads.
class TaskScheduler final : public btITaskScheduler {
 public:
  /// @p threads: the caller included, in [1, 64]; 0: as many as there are cores.
  /// @p executor: as in Settings; nullptr: oneTBB. Must outlive the scheduler.
  explicit TaskScheduler(int threads = 0, Executor* executor = nullptr);
  /// Takes itself out of Bullet.
  ~TaskScheduler() override;
  TaskScheduler(const TaskScheduler&) = delete;
  TaskScheduler& operator=(const TaskScheduler&) = delete;

  /// Why it stays on one thread, for people; empty if it does not have to.
  const std::string& complaint() const;
  /// That it uses, the caller included.
  int threads() const;

  /// What Bullet keeps a list for each of: whoever asks, whatever the pool that a thread is from,
  /// its number in Bullet is below that.
  int getNumThreads() const override { return BT_MAX_THREAD_COUNT; }
  int getMaxNumThreads() const override { return BT_MAX_THREAD_COUNT; }
  void setNumThreads(int threads) override;  ///< Not during a step.

  void parallelFor(int begin, int end, int grain, const btIParallelForBody& body) override;
  /// The same sum for any number of threads.
  btScalar parallelSum(int begin, int end, int grain, const btIParallelSumBody& body) override;

  void activate() override;
  void deactivate() override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
