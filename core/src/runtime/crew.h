// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "cairn/detail/memory.h"
#include "cairn/detail/spans.h"
#include "cairn/executor.h"

namespace cairn {

/// Work in stages, each a number of units that may be done at the same time. What a unit throws,
/// whoever does it, comes out of Crew::Run() when the others of its stage are done, or thrown, too.
class StagedWork {
 public:
  virtual int stages() const = 0;
  /// Asked once a stage, after GoOn().
  virtual int units(int stage) const = 0;
  virtual void Do(int stage, int unit) = 0;
  /// Asked on the caller's thread before each stage, when all before it are done; false ends the
  /// work.
  virtual bool GoOn(int stage);
  /// What a stage is in the record of a SpanRecorder.
  virtual SpanLabel label(int) const { return {}; }

 protected:
  ~StagedWork() = default;
};

/// The threads that work on one Solve().
///
/// One long task per helper, not one per stage: helpers stay awake between stages. The units of a
/// stage are cut into shares, one for each thread, so that a helper meets the same units in every
/// sweep. It claims them by an atomic of the share, then takes from other shares. Completion is
/// counted in units. Hence nobody waits for a helper that was not given a core, unless it has
/// claimed something.
class Crew : public detail::Placed {
 public:
  /// @p threads: the caller included, in [1, 1024]; one starts no others. Without an executor
  /// oneTBB, or std::thread, provides the helpers, as many as there are.
  explicit Crew(int threads, Executor* executor = nullptr);
  ~Crew();
  Crew(Crew&&) noexcept;
  Crew& operator=(Crew&&) noexcept;

  /// Becomes one of so many threads, if it is not already.
  void Follow(int threads, Executor* executor);

  /// Who takes down what is done from now on; nullptr: nobody. Not while helpers are here.
  void RecordTo(SpanRecorder* recorder);
  SpanRecorder* recorder() const { return recorder_; }

  /// Calls helpers, who stay until Dismiss(): @p most threads in all. Run() does so itself where
  /// nobody did before.
  void Call(int most = kMostThreads);
  void Dismiss();
  bool called() const;
  /// The caller, who never has helpers.
  bool alone() const { return alone_; }
  /// That may be at work now: more than one between Call() and Dismiss().
  int threads() const;

  /// Does all units of all stages, stage after stage, each unit once.
  void Run(StagedWork* work);
  /// The same, but calls nobody.
  void RunWithThoseHere(StagedWork* work);

 private:
  static constexpr int kMostThreads = 1024;
  void RunAlone(StagedWork* work) const;

  struct Impl;
  std::unique_ptr<Impl> impl_;
  SpanRecorder* recorder_ = nullptr;
  bool alone_;
};

}  // namespace cairn
