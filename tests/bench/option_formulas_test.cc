// SPDX-License-Identifier: MIT
// Prices of options that are known without a grid.
#include "problems/options/option_formulas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace cairn::problems {
namespace {

const OptionTerms kOneYear = {.strike = 100, .rate = 0.05, .maturity = 1};

AssetPair RandomPair(std::mt19937* random) {
  const auto between = [random](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(*random);
  };
  return {.first = {between(70, 130), between(0, 0.1), between(0.1, 0.8)},
          .second = {between(70, 130), between(0, 0.1), between(0.1, 0.8)},
          .rho = between(-0.97, 0.97)};
}

TEST(GaussRule, IsExactForPolynomialsUpToTwiceItsPoints) {
  for (const int count : {1, 2, 5, 20}) {
    const GaussRule rule(count);
    for (int power = 0; power < 2 * count; ++power) {
      const auto monomial = [power](double x) { return std::pow(x, power); };
      // A sum of `count` terms of size 1.
      EXPECT_NEAR(rule.Integrate(0, 1, monomial), 1.0 / (power + 1), 1e-15 * (count + 1))
          << count << ", " << power;
    }
  }
}

TEST(BivariateNormalCdf, IsTheProductForIndependentVariables) {
  for (const double x : {-3.0, -0.4, 0.0, 1.2}) {
    for (const double y : {-2.0, 0.3, 4.0}) {
      EXPECT_NEAR(BivariateNormalCdf(x, y, 0), NormalCdf(x) * NormalCdf(y), 1e-16);
    }
  }
}

TEST(BivariateNormalCdf, IsAnAngleAtTheOrigin) {
  for (const double rho : {-1.0, -0.999999, -0.95, -0.925, -0.5, 0.1, 0.8, 0.924, 0.99, 1.0}) {
    EXPECT_NEAR(BivariateNormalCdf(0, 0, rho), 0.25 + std::asin(rho) / (2 * std::numbers::pi),
                1e-14)
        << rho;
  }
}

// P(X <= x, Y <= y) is the integral of the density of X times P(Y <= y | X), in 400 panels of 20
// points up to where the density is below 1e-31.
TEST(BivariateNormalCdf, AgreesWithQuadrature) {
  const GaussRule rule(20);
  const auto by_quadrature = [&rule](double x, double y, double rho) {
    const auto f = [=](double t) {
      return std::exp(-t * t / 2) / std::sqrt(2 * std::numbers::pi) *
             NormalCdf((y - rho * t) / std::sqrt((1 - rho) * (1 + rho)));
    };
    constexpr int kPanels = 400;
    const double first = -12, width = (x - first) / kPanels;
    double sum = 0;
    for (int i = 0; i < kPanels; ++i) {
      sum += rule.Integrate(first + i * width, first + (i + 1) * width, f);
    }
    return sum;
  };
  std::mt19937 random(5);
  std::uniform_real_distribution<double> argument(-4, 4), correlation(-0.9999, 0.9999);
  for (int i = 0; i < 300; ++i) {
    const double x = argument(random), y = argument(random);
    // every third one in the range of the other formula
    const double rho = i % 3 == 0 ? std::copysign(0.96 + 0.039 * std::abs(correlation(random)),
                                                  correlation(random))
                                  : correlation(random);
    // both round at 1e-16, 400 panels add up to 1e-15
    EXPECT_NEAR(BivariateNormalCdf(x, y, rho), by_quadrature(x, y, rho), 1e-14)
        << x << ", " << y << ", " << rho;
  }
}

TEST(BivariateNormalCdf, HasItsLimitsFarOut) {
  for (const double rho : {-0.99, -0.3, 0.6, 0.97}) {
    EXPECT_EQ(BivariateNormalCdf(-60, 60, rho), 0);
    EXPECT_NEAR(BivariateNormalCdf(60, 0.3, rho), NormalCdf(0.3), 1e-15);
    EXPECT_NEAR(BivariateNormalCdf(60, 60, rho), 1, 1e-15);
  }
}

TEST(EuropeanPut, HasItsPublishedPrice) {
  // Andersen, Lake, Offengenden 2016, table 2: the digits printed there.
  EXPECT_NEAR(EuropeanPut({.spot = 100, .dividend = 0.05, .sigma = 0.25}, kOneYear), 9.462492596,
              5e-10);
}

// Given S1 = s: a put on S2 with strike K if s >= K; else K - s and an option to give s for S2.
double PutOnMinByQuadrature(const AssetPair& pair, const OptionTerms& terms) {
  const auto [first, second, rho] = pair;
  const double root = std::sqrt(terms.maturity), shared = rho * second.sigma;
  const double middle =
      std::log(first.spot) +
      (terms.rate - first.dividend - first.sigma * first.sigma / 2) * terms.maturity;
  const auto value_given = [&, first = first, second = second, rho = rho](double z) {
    const double s = std::exp(middle + first.sigma * root * z);
    const Asset rest = {
        second.spot * std::exp(shared * root * z - shared * shared / 2 * terms.maturity),
        second.dividend, second.sigma * std::sqrt(1 - rho * rho)};
    const double strike = std::min(s, terms.strike);
    const double value = std::exp(-terms.rate * terms.maturity) * (terms.strike - strike) +
                         EuropeanPut(rest, {strike, terms.rate, terms.maturity});
    return value * std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
  };
  // the kink at s = K is an end of panels
  const double kink =
      std::clamp((std::log(terms.strike) - middle) / (first.sigma * root), -9.0, 9.0);
  const GaussRule rule(20);
  constexpr int kPanels = 50;
  double sum = 0;
  for (int i = 0; i < kPanels; ++i) {
    const double low = (kink + 10) / kPanels, high = (10 - kink) / kPanels;
    sum += rule.Integrate(-10 + i * low, -10 + (i + 1) * low, value_given) +
           rule.Integrate(kink + i * high, kink + (i + 1) * high, value_given);
  }
  return sum;
}

TEST(EuropeanPutOnMin, AgreesWithThePutOnOneAssetGivenTheOther) {
  std::mt19937 random(11);
  for (int i = 0; i < 100; ++i) {
    const AssetPair pair = RandomPair(&random);
    const OptionTerms terms = {.strike = 100, .rate = 0.04, .maturity = i % 2 == 0 ? 0.2 : 2};
    // 100 times the rounding of probabilities; 5e-14 was seen
    EXPECT_NEAR(EuropeanPutOnMin(pair, terms), PutOnMinByQuadrature(pair, terms), 1e-12)
        << pair.rho << ", " << pair.first.sigma << ", " << pair.second.sigma;
  }
}

TEST(EuropeanPutOnAverage, IsTheSameFromEitherAsset) {
  std::mt19937 random(12);
  for (int i = 0; i < 20; ++i) {
    const AssetPair pair = RandomPair(&random);
    EXPECT_NEAR(EuropeanPutOnAverage(pair, kOneYear),
                EuropeanPutOnAverage({pair.second, pair.first, pair.rho}, kOneYear), 1e-12)
        << pair.rho << ", " << pair.first.sigma << ", " << pair.second.sigma;
  }
}

// An asset without risk is worth 100 e^(r T) at maturity: what is left is half a put on the other.
// One standard deviation of the nearly safe one is 1e-7.
TEST(EuropeanPutOnAverage, IsHalfAPutIfOneAssetIsSafe) {
  const Asset safe = {.spot = 100, .sigma = 1e-9}, risky = {.spot = 90, .sigma = 0.3};
  const OptionTerms rest = {.strike = 200 - 100 * std::exp(0.05), .rate = 0.05, .maturity = 1};
  EXPECT_NEAR(EuropeanPutOnAverage({safe, risky, 0.2}, kOneYear), EuropeanPut(risky, rest) / 2,
              1e-7);
}

}  // namespace
}  // namespace cairn::problems
