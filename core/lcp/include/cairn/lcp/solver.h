// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "cairn/lcp/problem.h"
#include "cairn/lcp/settings.h"

namespace cairn::lcp {

/// Whether the input could be used. All but kOk and kNotPositiveDefinite leave x untouched.
enum class Status {
  kOk,
  kBadSettings,   ///< Report::bad_setting is out of its range.
  kWrongSize,     ///< Sizes of the problem and x do not fit one another.
  kNotFinite,     ///< NaN, or infinity anywhere but in a bound.
  kBadBounds,     ///< lo > hi.
  kBadDiagonal,   ///< A diagonal entry of M is missing, zero or negative.
  kNotSymmetric,  ///< |M_ij - M_ji| above 1e-8 sqrt(M_ii M_jj).
  /// M could not be factorised, even with a proximal term of 1e-7 of its diagonal, or sweeps grew
  /// without end. The best iterate is returned: it is inside its bounds and usable.
  kNotPositiveDefinite,
  kOverflow,  ///< Numbers are finite, but too large or too far apart for a finite result.
};
/// One sentence for people, without a full stop.
std::string_view Describe(Status status);

/// Why the iteration ended.
enum class StopReason {
  kNotStarted,  ///< The input was refused.
  kConverged,   ///< LcpResidual::relative <= Settings::tolerance.
  kStationary,  ///< A sweep moved x by no more than Settings::min_progress.
  kStalled,     ///< Nothing the method has left brings the residual down: rounding decides.
  kBrokeDown,   ///< Report::status says why.
  kCancelled,   ///< The observer said so.
  kSweepLimit,  ///< Settings::max_sweeps done.
  kTimeSpent,   ///< Budget::Time reached.
  kWorkSpent,   ///< Budget::Work reached.
};
std::string_view Describe(StopReason reason);

/// Where the time went, wall clock; 0 unless the budget is a time.
struct Phases {
  std::chrono::nanoseconds layout{0};    ///< Checking the input, laying out rows.
  std::chrono::nanoseconds sweeps{0};    ///< Relaxing rows.
  std::chrono::nanoseconds ordering{0};  ///< Choosing the order of elimination.
  std::chrono::nanoseconds analysis{0};  ///< Symbolic factorisations.
  std::chrono::nanoseconds factorisation{0};
  std::chrono::nanoseconds solves{0};  ///< Forward and backward substitutions.
  std::chrono::nanoseconds other{0};   ///< Residuals, sets, step lengths, observers.
};

/// What was done, and how good the result is.
struct [[nodiscard]] Report {
  Status status = Status::kOk;
  BadSetting bad_setting;   ///< First setting refused.
  int bad_row = -1;         ///< First row refused, -1 if what is wrong is not a row.
  double residual_max = 0;  ///< LcpResidual::max, and its like.
  double residual_energy = 0;
  double residual_relative = 0;
  int sweeps = 0, factorisations = 0;
  int analyses = 0;                     ///< Symbolic factorisations.
  std::int64_t factor_nonzeros = 0;     ///< Entries of the largest factor.
  std::int64_t work = 0;                ///< Work units spent; see Budget::Work.
  std::chrono::nanoseconds elapsed{0};  ///< Wall clock of the Solve(), whatever the budget.
  Phases phases;
  StopReason stop = StopReason::kNotStarted;

  bool ok() const { return status == Status::kOk; }
};
/// One sentence for people, without a full stop: what is wrong, and where; or why it ended.
std::string Describe(const Report& report);

/// Judges the input as Solve() does; Report::bad_row is the first row refused. That M is positive
/// definite is found out while factorising.
Report Validate(const BoxedLcp& problem);
/// Sizes only (kWrongSize): the rest is judged in the boxed form, whose row n_a + i is row i of v.
Report Validate(const MixedLcp& problem);

/// A problem on its way to the solution.
struct Iterate {
  const Eigen::VectorXd& x;  ///< Inside the box.
  int sweeps = 0;            ///< So far.
  int factorisations = 0;
};

/// Looks at an iterate; false ends the iteration (StopReason::kCancelled).
using Observer = std::function<bool(const Iterate&)>;

/// Solves problems in matrix form. Our differences from the paper in Method::kPgsSm: rows join the
/// set by the sign of w, too, a singular reduced matrix gets a proximal term, interior point
/// iterations predict a set that does not settle, and the best iterate is returned.
///
/// Different solvers may run at the same time, one solver may not. It keeps the order of
/// elimination while the pattern of M stays the same.
class Solver {
 public:
  explicit Solver(const Settings& settings = {});
  ~Solver();
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;

  Settings& settings();
  const Settings& settings() const;

  /// @param[in,out] x  n values: the start (brought inside the box first) and the result.
  [[nodiscard]] Report Solve(const BoxedLcp& problem, Eigen::VectorXd* x);
  /// @param[in,out] u, v  n_a and n_b values, likewise. Report::bad_row counts u first, then v.
  [[nodiscard]] Report Solve(const MixedLcp& problem, Eigen::VectorXd* u, Eigen::VectorXd* v);

  /// From now on shows @p observer every iterate: after each sweep, each reduced solve and each
  /// interior point iteration. The clock of a Budget::Time does not stop for it. An empty function
  /// ends that.
  void Observe(Observer observer);
  /// Forgets everything learnt in earlier calls.
  void Reset();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::lcp
