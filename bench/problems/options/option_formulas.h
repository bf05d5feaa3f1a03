// SPDX-License-Identifier: MIT
// Prices that are known without a grid. Rates and volatilities are per year, times in years, prices
// in the unit of the spot.
#pragma once

#include <functional>
#include <vector>

namespace cairn::problems {

/// Nodes and weights of Gauss-Legendre quadrature on (-1, 1), exact for polynomials up to degree
/// 2 count - 1.
struct GaussRule {
  std::vector<double> nodes, weights;

  explicit GaussRule(int count);
  /// The integral of f from a to b.
  double Integrate(double a, double b, const std::function<double(double)>& f) const;
};

/// P(X <= x), X standard normal.
double NormalCdf(double x);

/// P(X <= x and Y <= y), both standard normal with correlation rho in [-1, 1]: Drezner and
/// Wesolowsky, J. Stat. Comput. Simul. 35 (1990) 101-107, with the correction near |rho| = 1 of
/// Genz, Stat. Comput. 14 (2004) 251-260. Ours has one rule of 20 points for every rho. Absolute
/// error below 1e-14.
double BivariateNormalCdf(double x, double y, double rho);

/// An asset that follows a geometric Brownian motion.
struct Asset {
  double spot = 0, dividend = 0, sigma = 0;  ///< spot, sigma > 0
};

/// What an option on one or two assets has besides them.
struct OptionTerms {
  double strike = 0, rate = 0, maturity = 0;  ///< strike >= 0, maturity > 0
};

/// The European put of Black, Scholes and Merton.
double EuropeanPut(const Asset& asset, const OptionTerms& terms);

/// Two assets whose Brownian motions have correlation rho, in (-1, 1).
struct AssetPair {
  Asset first, second;
  double rho = 0;
};

/// The European option that pays max(K - min(S1, S2), 0): the call on the minimum of Stulz, J.
/// Financial Econ. 10 (1982) 161-185, with dividends, and parity.
double EuropeanPutOnMin(const AssetPair& pair, const OptionTerms& terms);

/// The European option that pays max(K - (S1 + S2) / 2, 0). There is no closed form: given the
/// first asset it is a put on the second, and that is integrated over the first. Absolute error
/// below 1e-10 strikes.
double EuropeanPutOnAverage(const AssetPair& pair, const OptionTerms& terms);

}  // namespace cairn::problems
