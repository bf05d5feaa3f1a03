// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "cairn/tuning.h"
#include "lcp/lcp_solver.h"
#include "rows/row_problem.h"

namespace cairn::cli {

/// How far a solver may go, whichever comes first; without either it ends by itself.
struct RowLimit {
  std::optional<int> iterations;
  std::optional<std::chrono::nanoseconds> time;  ///< From the call of IterateUntil() on.
  /// That the time is measured with; nullptr: std::chrono::steady_clock. For tests.
  const Clock* clock = nullptr;
};

/// Says when a solver that iterates has to end: for (RowStop stop(limit); !stop(done); ++done) ...
/// One iteration is made in any case.
class RowStop {
 public:
  explicit RowStop(const RowLimit& limit) : limit_(limit), begin_(Now()) {}

  bool operator()(int iterations) const {
    if (limit_.iterations && iterations >= *limit_.iterations) return true;
    return iterations > 0 && limit_.time && spent() >= *limit_.time;
  }
  std::chrono::nanoseconds spent() const { return Now() - begin_; }

 private:
  std::chrono::nanoseconds Now() const {
    if (limit_.clock != nullptr) return limit_.clock->Now();
    return std::chrono::steady_clock::now().time_since_epoch();
  }

  RowLimit limit_;
  std::chrono::nanoseconds begin_;
};

/// What a solver made of a frame. Counts are 0 where they have no meaning.
struct RowOutcome {
  std::vector<double> impulses;      ///< One per row of RowProblem::rows.
  std::vector<Velocity> velocities;  ///< One per body.
  int iterations = 0, factorisations = 0, steps_accepted = 0, steps_restored = 0;
  bool ended = false;   ///< By itself: it would not go further with more time.
  std::string stop;     ///< Why it ended, a few words: "budget spent".
  std::string failure;  ///< Why it broke down; empty if it did not.
};

/// A solver of problems in row form, of any make. A new one is one class and one line in
/// row_solvers.cc; docs/solvers.md has an example.
class RowSolver {
 public:
  virtual ~RowSolver() = default;

  /// Takes a problem and its start (RowProblem::rows, row_impulses) into memory of its own, and
  /// forgets the one before. Not timed with the rest, but shown.
  /// @param problem  lives as long as it is solved
  /// @return why this solver cannot solve it, one sentence without a full stop; empty if it can
  virtual std::string Prepare(const RowProblem& problem) = 0;
  /// Solves from the start. Called once after each Prepare(), and timed.
  virtual void IterateUntil(const RowLimit& limit) = 0;
  /// Of the last IterateUntil(). Not timed.
  virtual RowOutcome Result() = 0;
};

}  // namespace cairn::cli
