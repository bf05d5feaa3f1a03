// SPDX-License-Identifier: MIT
#include "methods/barrier.h"

#include <algorithm>
#include <cmath>

namespace cairn::lcp {
namespace {

/// Share of the way to the boundary that a step may go.
constexpr double kBoundary = 0.995;
/// The start is at least so far inside, relative to the largest |w_i| / sqrt(d_i).
constexpr double kInside = 1e-3;
/// Of a narrow box, the start keeps this share to each bound.
constexpr double kShareOfBox = 0.25;
/// A box has no inside that matters if it is narrower than this share of its bounds, or than this
/// share of the distance that the start keeps to bounds.
constexpr double kNarrow = 1e-10, kTiny = 1e-16;
/// Proximal term of the factorisation relative to the diagonal, and the most it is raised to.
constexpr double kLeastShift = 1e-14, kMostShift = 1e-7;

/// Iterations that may bring nothing before the method ends, or starts again this much further from
/// the bounds if it is not feasible yet; and how often.
constexpr int kPatience = 10, kMostRestarts = 3;
constexpr double kLarger = 1000;
constexpr double kFeasible = 1e-6;
constexpr double kLess = 0.9;
/// Infeasibility and complementarity below these, relative to the problem, are rounding.
constexpr double kRoundingOfW = 1e-14, kRoundingOfGap = 1e-12;

double LargestWhere(const Eigen::VectorXd& values, const Eigen::VectorXd& diagonal) {
  return values.size() == 0 ? 0 : values.cwiseQuotient(diagonal.cwiseSqrt()).cwiseAbs().maxCoeff();
}

}  // namespace

Barrier::Barrier(LcpState* state, SparseCholesky* factor, const Eigen::VectorXd& start)
    : state_(state), factor_(factor), start_(start), moves_(start.size()), shift_(kLeastShift) {
  const BoxedLcp& problem = state->problem();
  const Eigen::VectorXd& d = state->diagonal();

  // how far from its law the worst row is, in the square root of the unit of x w
  const Eigen::VectorXd w = state->Slack(start);
  const Eigen::VectorXd natural =
      w.cwiseQuotient(d).cwiseMin(start - problem.lo).cwiseMax(start - problem.hi);
  const double worst = LargestWhere(natural.cwiseProduct(d), d);
  inside_ = std::max({worst, kInside * LargestWhere(w, d), 1e-300});

  for (Eigen::Index i = 0; i < start.size(); ++i) {
    const double lo = problem.lo[i], hi = problem.hi[i];
    const double narrow =
        std::max(kNarrow * std::max(std::abs(lo), std::abs(hi)), kTiny * inside_ / std::sqrt(d[i]));
    moves_[i] = std::isinf(hi - lo) || hi - lo > narrow;
  }
  {
    const PhaseClock clock = state_->Time(&Phases::analysis);
    factor_->Choose(moves_);
  }
  Begin();
}

void Barrier::Begin() {
  const BoxedLcp& problem = state_->problem();
  const Eigen::VectorXd& d = state_->diagonal();
  x_ = start_;
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    const double lo = problem.lo[i], hi = problem.hi[i];
    const double least = std::min(inside_ / std::sqrt(d[i]), kShareOfBox * (hi - lo));
    if (moves_[i]) x_[i] = std::min(std::max(x_[i], lo + least), hi - least);
  }

  bounds_.clear();
  const Eigen::VectorXd w = state_->Slack(x_);
  for (int i = 0; i < static_cast<int>(x_.size()); ++i) {
    const double lo = problem.lo[i], hi = problem.hi[i], least = inside_ * std::sqrt(d[i]);
    if (!moves_[i]) continue;
    if (std::isfinite(lo)) bounds_.push_back({i, 1, x_[i] - lo, std::max(w[i], least)});
    if (std::isfinite(hi)) bounds_.push_back({i, -1, hi - x_[i], std::max(-w[i], least)});
  }
  best_.fill(kInfinity);
  idle_ = 0;
  Measure();
}

bool Barrier::Fits() const { return state_->Fits(factor_->factor_flops()); }

void Barrier::Measure() {
  residual_ = state_->Slack(x_);
  for (const Bound& bound : bounds_) residual_[bound.row] -= bound.sign * bound.z;
  double size = 0;
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    if (!moves_[i]) residual_[i] = 0;
    size += residual_[i] * residual_[i] / state_->diagonal()[i];
  }
  infeasibility_ = std::sqrt(size) / state_->scale();
}

bool Barrier::Factorise() {
  weight_.setZero(x_.size());
  for (const Bound& bound : bounds_) weight_[bound.row] += bound.z / bound.slack;
  for (;; shift_ *= 100) {
    if (state_->Factorise(factor_, weight_ + shift_ * state_->diagonal())) return true;
    if (shift_ >= kMostShift || state_->done()) return false;
  }
}

void Barrier::SolveStep(const Eigen::VectorXd& targets) {
  Eigen::VectorXd rhs = -residual_;
  for (size_t k = 0; k < bounds_.size(); ++k) {
    rhs[bounds_[k].row] += bounds_[k].sign * targets[k] / bounds_[k].slack;
  }

  // the barrier spoils the conditioning: one refinement against M and the weights themselves
  step_ = rhs;
  state_->Solve(*factor_, &step_);
  Eigen::VectorXd rest = rhs - weight_.cwiseProduct(step_) - state_->Multiply(step_);
  for (Eigen::Index i = 0; i < rest.size(); ++i) {
    if (!moves_[i]) rest[i] = 0;
  }
  state_->Solve(*factor_, &rest);
  step_ += rest;

  for (size_t k = 0; k < bounds_.size(); ++k) {
    Bound& bound = bounds_[k];
    bound.slack_step = bound.sign * step_[bound.row];
    bound.z_step = (targets[k] - bound.z * bound.slack_step) / bound.slack;
  }
}

double Barrier::LongestStep() const {
  double longest = 1 / kBoundary;
  for (const Bound& bound : bounds_) {
    if (bound.slack_step < 0) longest = std::min(longest, -bound.slack / bound.slack_step);
    if (bound.z_step < 0) longest = std::min(longest, -bound.z / bound.z_step);
  }
  return longest;
}

bool Barrier::Advances(double residual) {
  const double gap = std::sqrt(Complementarity(0)) / state_->scale();
  const double now[] = {residual, std::max(infeasibility_, kRoundingOfW),
                        std::max(gap, kRoundingOfGap)};
  ++idle_;
  for (int k = 0; k < 3; ++k) {
    if (!(now[k] < kLess * best_[k])) continue;
    best_[k] = now[k];
    idle_ = 0;
  }
  if (idle_ < kPatience) return true;

  // steps too short to get anywhere: the solution is far larger than the start, so start larger
  if (infeasibility_ <= kFeasible || restarts_ == kMostRestarts) return false;
  ++restarts_;
  inside_ *= kLarger;
  Begin();
  return true;
}

double Barrier::Complementarity(double length) const {
  double sum = 0;
  for (const Bound& bound : bounds_) {
    sum += (bound.slack + length * bound.slack_step) * (bound.z + length * bound.z_step);
  }
  return sum;
}

bool Barrier::Step() {
  if (!Factorise()) return false;

  // predictor: straight at slack z = 0
  Eigen::VectorXd targets(bounds_.size());
  for (size_t k = 0; k < bounds_.size(); ++k) targets[k] = -bounds_[k].slack * bounds_[k].z;
  SolveStep(targets);
  for (Bound& bound : bounds_) {
    bound.indicator = bound.slack_step / bound.slack - bound.z_step / bound.z;
  }

  // corrector: back towards the centre as far as the predictor fell short, second order included
  if (!bounds_.empty()) {
    const double before = Complementarity(0);
    const double ratio = Complementarity(std::min(1.0, LongestStep())) / before;
    const double centre = ratio * ratio * ratio * before / static_cast<double>(bounds_.size());
    for (size_t k = 0; k < bounds_.size(); ++k) {
      targets[k] += centre - bounds_[k].slack_step * bounds_[k].z_step;
    }
    SolveStep(targets);
  }
  Move(std::min(1.0, kBoundary * LongestStep()));
  return true;
}

void Barrier::Move(double length) {
  length_ = length;
  x_ += length * step_;
  for (Bound& bound : bounds_) {
    bound.slack += length * bound.slack_step;
    bound.z += length * bound.z_step;
  }
  // the nearer bound says where x is, to all digits of the slack
  const BoxedLcp& problem = state_->problem();
  for (const Bound& bound : bounds_) {
    double& x = x_[bound.row];
    const double place = bound.sign > 0 ? problem.lo[bound.row] : problem.hi[bound.row];
    if (bound.slack <= 0.5 * (problem.hi[bound.row] - problem.lo[bound.row])) {
      x = place + bound.sign * bound.slack;
    }
  }
  Measure();
}

Eigen::VectorXd Barrier::Rounded() const {
  Eigen::VectorXd rounded = x_;
  for (const Bound& bound : bounds_) {
    // slack and z / d are both changes of x
    if (bound.slack * state_->diagonal()[bound.row] >= bound.z) continue;
    const BoxedLcp& problem = state_->problem();
    rounded[bound.row] = bound.sign > 0 ? problem.lo[bound.row] : problem.hi[bound.row];
  }
  // rows that stand still go to the bound that w wants
  const Eigen::VectorXd w = state_->Slack(rounded);
  for (Eigen::Index i = 0; i < rounded.size(); ++i) {
    if (moves_[i] || w[i] == 0) continue;
    rounded[i] = w[i] > 0 ? state_->problem().lo[i] : state_->problem().hi[i];
  }
  return rounded;
}

RowSet Barrier::Predicted() const {
  RowSet set(x_.size(), Side::kFree);
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    if (!moves_[i]) set[i] = Side::kLower;
  }
  for (const Bound& bound : bounds_) {
    if (bound.indicator < 0) set[bound.row] = bound.sign > 0 ? Side::kLower : Side::kUpper;
  }
  return set;
}

}  // namespace cairn::lcp
