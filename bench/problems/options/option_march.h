// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "problems/problem.h"

namespace cairn::problems {

enum class Exercise {
  kEuropean,  ///< At maturity only: the steps are equations, lo = -inf.
  kAmerican,  ///< At any time: lo = 0.
};

/// How the time steps of a march are spread.
enum class TimeGrid {
  kUniform,
  /// tau = end (m / steps)^2. Near maturity the exercise boundary moves like sqrt(tau), which equal
  /// steps resolve to order 3/2 only; these to order 2 (Reisinger, Whitley, IMA J. Numer. Anal. 34
  /// (2014) 1156-1192).
  kQuadratic,
};

/// An option after the transformation that makes its equation a heat equation, on the nodes inside
/// a grid: u' = -A u + b(tau), and u >= g(tau) = e^(growth tau) payoff where it is American. tau
/// runs backwards from maturity, in the unit of `end`.
struct OptionModel {
  std::string name, source;
  Exercise exercise = Exercise::kAmerican;
  Eigen::SparseMatrix<double> A;  ///< n x n, symmetric positive definite M-matrix.
  double end = 0;                 ///< tau today.
  int steps = 0;                  ///< Up to there, >= 4.
  TimeGrid time_grid = TimeGrid::kUniform;
  double growth = 0;
  Eigen::VectorXd payoff;   ///< n, at the nodes.
  Eigen::VectorXd initial;  ///< n, u(0): the payoff, its kinks smoothed or not.
  /// b(tau), n: what the known values on the boundary of the grid contribute.
  std::function<Eigen::VectorXd(double tau)> boundary;
  /// Answers about u(end); OptionMarch makes them answers about x.
  std::vector<Answer> answers;

  Eigen::VectorXd Obstacle(double tau) const;
};

/// Steps through the life of an option. The unknowns are y = u - g at the end of the step:
///   M = I + theta dtau A,
///   q = M g - (I - (1 - theta) dtau A) u - dtau (theta b + (1 - theta) b_before),
/// theta = 1/2 (Crank-Nicolson), but the first two steps are four half steps with theta = 1
/// (Rannacher, Numer. Math. 43 (1984) 309-327), which damp what the kinks of the payoff excite. On
/// a uniform time grid M is the same in all. The warm start is y of the step before.
class OptionMarch : public Source {
 public:
  explicit OptionMarch(OptionModel model);

  int steps() const override { return model_.steps + kExtraSteps; }
  const Problem& current() const override { return problem_; }
  bool Advance(const Eigen::VectorXd& y) override;

 private:
  static constexpr int kHalfSteps = 4, kExtraSteps = kHalfSteps / 2;

  /// The end of step `index`; the start of step 0 for -1.
  double TimeAfter(int index) const;
  void SetUp(const Eigen::VectorXd& warm_start);

  OptionModel model_;
  Eigen::VectorXd u_;  ///< At the start of the present step.
  int index_ = 0;
  Problem problem_;
};

/// The answer y of a step of a march.
using StepSolver = std::function<Eigen::VectorXd(const Problem& step)>;

/// One step of a march as a problem of its own, with its solution and slack: the middle one, unless
/// that is still a half step. `solve` is accurate to rounding.
Problem MiddleStep(OptionMarch march, const std::string& name, const StepSolver& solve);

}  // namespace cairn::problems
