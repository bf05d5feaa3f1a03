// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <chrono>
#include <cstdint>

namespace cairn {

/// What one Solve() may cost. The state is a valid, feasible answer after every block of rows: a
/// budget decides how good the answer is. Tuning::min_sweeps are made in any case.
class Budget {
 public:
  enum class Kind { kUnlimited, kTime, kWork };

  /// No limit: Settings::tolerance and Settings::max_sweeps decide.
  static constexpr Budget Unlimited() { return Budget(Kind::kUnlimited, 0); }

  /// Wall-clock time from the call of Solve() on [ns], >= 0. The clock is read every 10,000 rows or
  /// so, and what writing the results will take is set aside. Accelerated sweeps and subspace steps
  /// start only if their predicted cost fits; a step is given up where it takes longer.
  /// Results depend on the machine: Report::replay makes them again, but for substeps and relax.
  /// cairn::lcp reads the clock between sweeps and between factorisations, not inside them.
  static constexpr Budget Time(std::chrono::nanoseconds limit) {
    return Budget(Kind::kTime, limit.count());
  }

  /// The deterministic twin: work units, >= 0; 1 unit = 1 row relaxation. Residuals and subspace
  /// steps are charged from counts alone, and no result depends on the clock.
  static constexpr Budget Work(std::int64_t units) { return Budget(Kind::kWork, units); }

  constexpr Kind kind() const { return kind_; }
  /// @pre kind() == Kind::kTime
  constexpr std::chrono::nanoseconds time() const { return std::chrono::nanoseconds(amount_); }
  /// @pre kind() == Kind::kWork
  constexpr std::int64_t work() const { return amount_; }
  /// False for a negative time or amount of work.
  constexpr bool valid() const { return amount_ >= 0; }

  friend constexpr bool operator==(const Budget&, const Budget&) = default;

 private:
  constexpr Budget(Kind kind, std::int64_t amount) : kind_(kind), amount_(amount) {}

  Kind kind_;
  std::int64_t amount_;
};

}  // namespace cairn
