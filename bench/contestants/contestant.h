// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "cairn/bullet/constraint_solver.h"
#include "cairn/detail/spans.h"
#include "measure/observed.h"

namespace cairn::cli {

/// What a solver may spend on a substep.
struct Effort {
  int iterations = 10;                             ///< For solvers that count.
  std::optional<std::chrono::nanoseconds> budget;  ///< For solvers that have a clock.
  std::optional<std::int64_t> units;               ///< For these, instead: counted work.
};

/// What a solver did in a substep.
struct Work {
  int iterations = 0;
  int steps_accepted = 0, steps_restored = 0, factorisations = 0;
  int guarded = 0;  ///< Islands on which something was guarded; see cairn::Guards.
};

/// A solver under test, of any make.
class Contestant {
 public:
  using Observer = std::function<void(const ContactProblem&, std::span<const double> impulses)>;

  virtual ~Contestant() = default;

  virtual btConstraintSolver* solver() = 0;
  /// The same, if it is Cairn's.
  virtual bullet::ConstraintSolver* cairn() { return nullptr; }
  /// Before each substep. Writes the settings of the world that the solver needs into `info`.
  virtual void Begin(const Effort& effort, btContactSolverInfo* info) = 0;
  /// Of the last substep.
  virtual Work work() const = 0;
  /// Why the solver did not do the last substep; empty if it did.
  virtual std::string refusal() const { return {}; }
  /// Share of its calls that were left to another solver, in [0, 1]; none for solvers that do
  /// everything themselves.
  virtual std::optional<double> fallback_share() const { return {}; }

  /// Takes down the spans of threads from now on, where the solver can; nullptr: no more.
  virtual void RecordSpans(SpanRecorder*) {}
  /// Threads that may work on a substep: 1, or as many as were allowed to a solver that has
  /// threads.
  virtual int threads() { return 1; }
  virtual void AllowThreads(int) {}

  /// Called with each solved group; none stops observing.
  virtual void Observe(Observer observer) = 0;
  /// Time spent observing since the last call.
  virtual std::chrono::nanoseconds TakeObservingTime() = 0;
};

/// What all contestants share.
template <class Solver>
class ObservedContestant : public Contestant {
 public:
  btConstraintSolver* solver() override { return &solver_; }
  void Observe(Observer observer) override {
    if (!observer) return solver_.Observe(nullptr);
    solver_.Observe([observer = std::move(observer)](bullet::GroupRows& rows) {
      observer(rows.problem(), rows.impulses());
    });
  }
  std::chrono::nanoseconds TakeObservingTime() override { return solver_.TakeObservingTime(); }

 protected:
  template <class... Arguments>
  explicit ObservedContestant(Arguments&&... arguments)
      : solver_(std::forward<Arguments>(arguments)...) {}

  bench::Observed<Solver> solver_;
};

}  // namespace cairn::cli
