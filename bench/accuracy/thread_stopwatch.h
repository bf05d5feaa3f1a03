// SPDX-License-Identifier: MIT
#pragma once

namespace cairn::accuracy {

/// What something took the thread that did it.
struct ThreadTime {
  double cpu = 0, wall = 0;  ///< [ms]
  bool preempted = false;    ///< It was taken off its core meanwhile.
};

/// Runs from its construction on.
class ThreadStopwatch {
 public:
  ThreadTime Read() const;

 private:
  static ThreadTime Now();
  static long Preemptions();

  long preemptions_ = Preemptions();
  ThreadTime start_ = Now();
};

}  // namespace cairn::accuracy
