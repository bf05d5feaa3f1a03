// SPDX-License-Identifier: MIT
#include "problems/options/option_formulas.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cairn::problems {
namespace {

constexpr double kPi = std::numbers::pi;

double NormalDensity(double x) { return std::exp(-x * x / 2) / std::sqrt(2 * kPi); }

/// The 20 points that Genz takes for large correlations.
const GaussRule& CdfRule() {
  static const GaussRule rule(20);
  return rule;
}

/// P(X > h and Y > k) for |rho| < 0.925: Plackett's integral over the angle whose sine is rho.
double UpperOrthant(double h, double k, double rho) {
  const double squares = (h * h + k * k) / 2;
  const double integral = CdfRule().Integrate(0, std::asin(rho), [&](double angle) {
    const double sine = std::sin(angle);
    return std::exp((sine * h * k - squares) / (1 - sine * sine));
  });
  return integral / (2 * kPi) + NormalCdf(-h) * NormalCdf(-k);
}

/// What P(X > h and Y > k) lacks to P(X > max(h, k)) for a correlation rho near 1: the integrand
/// has a peak there, whose expansion is integrated exactly and whose remainder is by quadrature.
double PeakedIntegral(double h, double k, double rho) {
  const double hk = h * k, squared = (1 - rho) * (1 + rho), width = std::sqrt(squared);
  const double distance = std::abs(h - k), bs = distance * distance;
  const double c = (4 - hk) / 8, d = (12 - hk) / 16;

  if (width == 0) return 0;
  double value = width * std::exp(-(bs / squared + hk) / 2) *
                 (1 - c * (bs - squared) * (1 - d * bs / 5) / 3 + c * d * squared * squared / 5);
  // beyond that the exponential overflows, and what it is multiplied with is below 1e-300
  if (hk > -100) {
    value -= std::exp(-hk / 2) * std::sqrt(2 * kPi) * NormalCdf(-distance / width) * distance *
             (1 - c * bs * (1 - d * bs / 5) / 3);
  }
  value += CdfRule().Integrate(0, width, [&](double t) {
    const double x = t * t, root = std::sqrt(1 - x);
    return std::exp(-(bs / x + hk) / 2) *
           (std::exp(-hk * x / (2 * (1 + root) * (1 + root))) / root - (1 + c * x * (1 + d * x)));
  });
  return value / (2 * kPi);
}

double UpperOrthantOfLikeAssets(double h, double k, double rho) {
  if (rho > 0) return NormalCdf(-std::max(h, k)) - PeakedIntegral(h, k, rho);
  // X and -Y are alike.
  return std::max(0.0, NormalCdf(-h) - NormalCdf(k)) + PeakedIntegral(h, -k, -rho);
}

/// (ln(spot / strike) + drift T) / (sigma sqrt(T)).
double Moneyness(const Asset& asset, const OptionTerms& terms, double half_variance_sign) {
  const double drift =
      terms.rate - asset.dividend + half_variance_sign * asset.sigma * asset.sigma / 2;
  return (std::log(asset.spot / terms.strike) + drift * terms.maturity) /
         (asset.sigma * std::sqrt(terms.maturity));
}

/// Today's value of the asset at maturity.
double Prepaid(const Asset& asset, const OptionTerms& terms) {
  return asset.spot * std::exp(-asset.dividend * terms.maturity);
}

/// Today's value of `own` at maturity where it is the smaller one, and where it is also above the
/// strike: both under the measure that counts in units of `own`.
struct SmallerAsset {
  double always, above_strike;
};

SmallerAsset ValueOfSmaller(const Asset& own, const Asset& other, double rho,
                            const OptionTerms& terms) {
  const double spread = std::sqrt(own.sigma * own.sigma + other.sigma * other.sigma -
                                  2 * rho * own.sigma * other.sigma);
  // own is a bond with the yield of its dividends here, and the strike of an option on the other
  const double smaller =
      Moneyness({.spot = other.spot, .dividend = other.dividend, .sigma = spread},
                {.strike = own.spot, .rate = own.dividend, .maturity = terms.maturity}, -1);
  const double value = Prepaid(own, terms);
  return {value * NormalCdf(smaller),
          value * BivariateNormalCdf(Moneyness(own, terms, 1), smaller,
                                     (rho * other.sigma - own.sigma) / spread)};
}

}  // namespace

GaussRule::GaussRule(int count) : nodes(count), weights(count) {
  for (int i = 0; i < count; ++i) {
    // Newton's method on the Legendre polynomial, from Tricomi's estimate of its zero.
    double x = -std::cos(kPi * (i + 0.75) / (count + 0.5)), slope = 0;
    for (int newton = 0; newton < 10; ++newton) {
      double p = 1, previous = 0;
      for (int k = 1; k <= count; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * previous) / k;
        previous = p;
        p = next;
      }
      slope = count * (x * p - previous) / (x * x - 1);
      x -= p / slope;
    }
    nodes[i] = x;
    weights[i] = 2 / ((1 - x * x) * slope * slope);
  }
}

double GaussRule::Integrate(double a, double b, const std::function<double(double)>& f) const {
  double sum = 0;
  for (size_t i = 0; i < nodes.size(); ++i) {
    sum += weights[i] * f((a + b) / 2 + (b - a) / 2 * nodes[i]);
  }
  return sum * (b - a) / 2;
}

double NormalCdf(double x) { return std::erfc(-x / std::numbers::sqrt2) / 2; }

double BivariateNormalCdf(double x, double y, double rho) {
  return std::abs(rho) < 0.925 ? UpperOrthant(-x, -y, rho) : UpperOrthantOfLikeAssets(-x, -y, rho);
}

double EuropeanPut(const Asset& asset, const OptionTerms& terms) {
  if (terms.strike <= 0) return 0;
  return terms.strike * std::exp(-terms.rate * terms.maturity) *
             NormalCdf(-Moneyness(asset, terms, -1)) -
         Prepaid(asset, terms) * NormalCdf(-Moneyness(asset, terms, 1));
}

double EuropeanPutOnMin(const AssetPair& pair, const OptionTerms& terms) {
  const auto [first, second, rho] = pair;
  const SmallerAsset one = ValueOfSmaller(first, second, rho, terms);
  const SmallerAsset two = ValueOfSmaller(second, first, rho, terms);
  const double bond = terms.strike * std::exp(-terms.rate * terms.maturity);
  const double call =
      one.above_strike + two.above_strike -
      bond * BivariateNormalCdf(Moneyness(first, terms, -1), Moneyness(second, terms, -1), rho);
  return call + bond - (one.always + two.always);
}

double EuropeanPutOnAverage(const AssetPair& pair, const OptionTerms& terms) {
  const auto [first, second, rho] = pair;
  const double root = std::sqrt(terms.maturity);
  // The second asset given the normal variable z of the first: less volatile, and moved.
  const auto value_given = [&, first = first, second = second, rho = rho](double z) {
    const double strike =
        2 * terms.strike -
        first.spot * std::exp((terms.rate - first.dividend - first.sigma * first.sigma / 2) *
                                  terms.maturity +
                              first.sigma * root * z);
    const double shared = rho * second.sigma;
    const Asset rest = {
        .spot = second.spot * std::exp(shared * root * z - shared * shared * terms.maturity / 2),
        .dividend = second.dividend,
        .sigma = second.sigma * std::sqrt(1 - rho * rho)};
    return NormalDensity(z) *
           EuropeanPut(rest, {.strike = strike, .rate = terms.rate, .maturity = terms.maturity}) /
           2;
  };
  // The trapezoidal rule converges faster than any power on a smooth function that decays at both
  // ends; beyond 10 the normal density is below 1e-22.
  constexpr int kPanels = 4000;
  constexpr double kEnd = 10;
  double sum = 0;
  for (int i = 0; i <= kPanels; ++i) sum += value_given(-kEnd + 2 * kEnd * i / kPanels);
  return sum * 2 * kEnd / kPanels;
}

}  // namespace cairn::problems
