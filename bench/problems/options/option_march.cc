// SPDX-License-Identifier: MIT
#include "problems/options/option_march.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cairn::problems {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

Eigen::SparseMatrix<double> Identity(Eigen::Index n) {
  Eigen::SparseMatrix<double> identity(n, n);
  identity.setIdentity();
  return identity;
}

}  // namespace

Eigen::VectorXd OptionModel::Obstacle(double tau) const { return std::exp(growth * tau) * payoff; }

OptionMarch::OptionMarch(OptionModel model) : model_(std::move(model)), u_(model_.initial) {
  const Eigen::Index n = u_.size();
  const double lowest = model_.exercise == Exercise::kAmerican ? 0 : -kInf;
  problem_.name = model_.name;
  problem_.source = model_.source;
  problem_.lcp.lo = Eigen::VectorXd::Constant(n, lowest);
  problem_.lcp.hi = Eigen::VectorXd::Constant(n, kInf);
  SetUp(u_ - model_.payoff);
}

bool OptionMarch::Advance(const Eigen::VectorXd& y) {
  if (index_ + 1 >= steps()) return false;
  u_ = y + model_.Obstacle(TimeAfter(index_));
  ++index_;
  SetUp(y);
  return true;
}

double OptionMarch::TimeAfter(int index) const {
  const int done = index + 1;
  const double whole = done < kHalfSteps ? done / 2.0 : done - kExtraSteps;
  const double share = whole / model_.steps;
  return model_.end * (model_.time_grid == TimeGrid::kQuadratic ? share * share : share);
}

void OptionMarch::SetUp(const Eigen::VectorXd& warm_start) {
  const double before = TimeAfter(index_ - 1), after = TimeAfter(index_);
  const double dtau = after - before;
  const double theta = index_ < kHalfSteps ? 1 : 0.5;

  Eigen::VectorXd right = u_ + dtau * theta * model_.boundary(after);
  if (theta < 1) {
    right += dtau * (1 - theta) * (model_.boundary(before) - model_.A * u_);
  }
  const Eigen::VectorXd obstacle = model_.Obstacle(after);
  problem_.lcp.M = Identity(u_.size()) + dtau * theta * model_.A;
  problem_.lcp.q = problem_.lcp.M * obstacle - right;
  problem_.start = warm_start.cwiseMax(problem_.lcp.lo);

  if (index_ + 1 < steps()) return;
  problem_.answers = model_.answers;
  for (Answer& answer : problem_.answers) {
    answer.measure = [obstacle, of_u = answer.measure](const Eigen::VectorXd& y) {
      return of_u(y + obstacle);
    };
  }
}

Problem MiddleStep(OptionMarch march, const std::string& name, const StepSolver& solve) {
  const int middle = std::max(march.steps() / 2, 4);
  Eigen::VectorXd y = solve(march.current());
  for (int step = 0; step < middle && march.Advance(y); ++step) y = solve(march.current());

  Problem problem = march.current();
  problem.name = name;
  problem.answers.clear();
  problem.solution = y;
  problem.slack = problem.lcp.M * y + problem.lcp.q;
  return problem;
}

}  // namespace cairn::problems
