// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <algorithm>
#include <memory>

#include "cairn/detail/spans.h"
#include "cairn/executor.h"

namespace cairn {

class Crew;

namespace detail {

/// Parts of work that may be done at the same time, in any order.
class PartedWork {
 public:
  virtual void Do(int part) = 0;

 protected:
  ~PartedWork() = default;
};

/// The threads of a Solver, for hosts that read and write their own objects on them. As in a
/// Solve(), nobody waits for a helper that was not given a core.
class Threads {
 public:
  Threads();
  ~Threads();
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  /// As Settings::threads and Settings::executor say from now on. @pre threads in [1, 1024]
  void Follow(int threads, Executor* executor);
  /// Calls helpers, who stay until Dismiss(): @p most threads in all, the caller included.
  void Call(int most);
  void Dismiss();
  /// Whether there may be helpers now.
  bool several() const;

  /// Each part once; all are done when it returns. Without helpers the caller does all, in order.
  void Do(int parts, PartedWork* work, SpanLabel label = {});
  /// function(first, count) for all parts of a range, @p of_part of it at a time.
  template <class Function>
  void For(int size, int of_part, const Function& function, SpanLabel label = {}) {
    Range<Function> range(size, of_part, function);
    Do((size + of_part - 1) / of_part, &range, label);
  }
  /// Who takes down what they do from now on; nullptr: nobody. Not while helpers are here.
  void RecordTo(SpanRecorder* recorder);
  SpanRecorder* recorder() const;

  Crew& crew() { return *crew_; }  ///< for the Solver

 private:
  template <class Function>
  class Range final : public PartedWork {
   public:
    Range(int size, int of_part, const Function& function)
        : size_(size), of_part_(of_part), function_(function) {}
    void Do(int part) override {
      const int first = part * of_part_;
      function_(first, std::min(of_part_, size_ - first));
    }

   private:
    int size_, of_part_;
    const Function& function_;
  };

  std::unique_ptr<Crew> crew_;
};

/// Keeps helpers awake while it lives: those of Threads, or of a Crew.
template <class Team>
class AwakeHelpers {
 public:
  /// @p most threads; one calls nobody.
  AwakeHelpers(Team* team, int most) : team_(most > 1 ? team : nullptr) {
    if (team_ != nullptr) team_->Call(most);
  }
  ~AwakeHelpers() {
    if (team_ != nullptr) team_->Dismiss();
  }
  AwakeHelpers(const AwakeHelpers&) = delete;
  AwakeHelpers& operator=(const AwakeHelpers&) = delete;

 private:
  Team* team_;
};

/// How many threads are worth calling for a problem of so many rows: what waits costs more than it
/// does where there is little.
inline int ThreadsFor(int rows, int threads) {
  constexpr int kRowsOfThread = 2048;
  return std::clamp(rows / kRowsOfThread, 1, threads);
}

}  // namespace detail
}  // namespace cairn
