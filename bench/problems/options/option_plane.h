// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "problems/options/option_formulas.h"
#include "problems/options/option_march.h"

namespace cairn::problems {

/// An option on two assets: V(T) = strike payoff(S1 / strike, S2 / strike).
struct PairOption {
  AssetPair pair;
  OptionTerms terms;
  std::function<double(double, double)> payoff;
};

/// Options on two assets in the variables that make their equation isotropic and free of drift:
/// x_i = ln(S_i / K), Sigma = L L' their covariance per year, y = L^-1 x,
/// beta = L^-1 (r - q_i - sigma_i^2 / 2), tau = T - t [years] and, with y_0 today's spot,
///   V = K exp(-beta (y - y_0)) u(y, tau),   u_tau = 1/2 Lap u - (|beta|^2 / 2 + r) u.
/// Taking the last term into u as a factor exp((|beta|^2 / 2 + r) tau) leaves the heat equation,
/// whose solution grows too fast for few time steps if the assets drift; here it is part of M, and
/// the obstacle stays what it is.
///
/// The grid is a square around y_0, which is a node. It reaches 5 standard deviations and the drift
/// beyond; a Brownian motion from y_0 leaves it with a probability below 5e-6. On its boundary the
/// option is worth what it pays on the forwards, discounted, or more by exercise.
class OptionPlane {
 public:
  /// @param side  nodes along each side, >= 2.
  OptionPlane(const PairOption& option, int side);

  /// All but the name, source and answers.
  OptionModel Model(Exercise exercise, int steps) const;

  /// V at today's spot, given u today.
  double Price(const Eigen::VectorXd& u) const;

  /// Most that Price() may be off after a march of that many steps, measured against
  /// EuropeanPutOnMin() and EuropeanPutOnAverage(): see the source.
  double ErrorBound(int steps) const;

  const PairOption& option() const { return option_; }

 private:
  struct Point {
    double y1, y2;  ///< From y_0.
  };

  int Index(int i, int j) const { return j * side_ + i; }
  Point NodeAt(int i, int j) const { return {(i - side_ / 2) * h_, (j - side_ / 2) * h_}; }
  /// u over V / K.
  double Scale(const Point& point) const;
  double decay() const;
  /// What the option pays over K, on assets that have grown by these factors.
  double Payoff(const Point& point, double growth1 = 1, double growth2 = 1) const;
  /// The average of u(0) over the cell around a node.
  double CellAverage(const Point& node) const;
  double BoundaryValue(Exercise exercise, const Point& point, double tau) const;
  Eigen::SparseMatrix<double> Matrix() const;
  Eigen::VectorXd Boundary(Exercise exercise, double tau) const;

  PairOption option_;
  int side_;
  double h_ = 0;
  double l21_ = 0, l22_ = 0;  ///< L = [sigma1 0; l21 l22]
  double beta1_ = 0, beta2_ = 0;
};

}  // namespace cairn::problems
