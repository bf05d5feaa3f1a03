// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

namespace cairn {

/// Where a Solver gets its threads from (Settings::executor). A game that has a job system of its
/// own hands it in here, so that its threads and ours do not compete for the cores: Submit() puts
/// [work, what] { work(what); } in its queue.
///
/// A Solve() on n threads submits up to n - 1 tasks when it begins and never waits for one to
/// start: the calling thread does whatever no other has taken. A task works until the Solve() ends
/// and then returns; one that starts later returns at once.
class Executor {
 public:
  Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;
  virtual ~Executor() = default;

  /// Calls work(what) once, now or later, on a thread other than the caller's. Called by the thread
  /// that called Solve(). The call may come after the Solver is gone; it allocates nothing and does
  /// not throw. What Submit() throws is thrown by Solve(); then work(what) must not be called.
  virtual void Submit(void (*work)(void*), void* what) = 0;
};

}  // namespace cairn
