// SPDX-License-Identifier: MIT
#include "runtime/logarithm.h"

#include <cmath>
#include <limits>

namespace cairn {
namespace {

/// ln 2 in two parts: the first has so few digits that its product with an exponent is exact.
constexpr double kLogTwoHigh = 0x1.62e42feep-1, kLogTwoLow = 0x1.a39ef35793c76p-33;
constexpr double kLogTwo = 0x1.62e42fefa39efp-1;
constexpr double kRootHalf = 0.70710678118654752;
/// Beyond these e^x - 1 is -1 and infinity.
constexpr double kLeast = -40, kMost = 709.79;

/// e^x - 1 for |x| <= ln 2 / 2, by its series.
double ExpMinusOneNearZero(double x) {
  double sum = 0;
  for (int n = 16; n > 0; --n) sum = (1 + sum) * (x / n);
  return sum;
}

}  // namespace

double Log(double x) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!(x > 0)) return x == 0 ? -infinity : std::numeric_limits<double>::quiet_NaN();
  if (x == infinity) return x;

  // x = m 2^e with m in [sqrt(1/2), sqrt(2)): both are exact
  int e = 0;
  double m = std::frexp(x, &e);
  if (m < kRootHalf) {
    m *= 2;
    --e;
  }
  // ln m = 2 (s + s^3 / 3 + s^5 / 5 + ...), |s| < 0.172
  const double s = (m - 1) / (m + 1), square = s * s;
  double sum = 0;
  for (int n = 21; n > 1; n -= 2) sum = (1.0 / n + sum) * square;
  return e * kLogTwoHigh + (e * kLogTwoLow + 2 * (s + s * sum));
}

double ExpMinusOne(double x) {
  if (x < kLeast) return -1;
  if (x > kMost) return std::numeric_limits<double>::infinity();
  if (!(std::abs(x) > kLogTwo / 2)) return ExpMinusOneNearZero(x);
  // x = e ln 2 + rest, e^x - 1 = 2^e (e^rest - 1) + (2^e - 1)
  const double e = std::floor(x / kLogTwo + 0.5);
  const double rest = (x - e * kLogTwoHigh) - e * kLogTwoLow;
  // in two halves: 2^1024 would be infinite
  const int half = static_cast<int>(e) / 2, other = static_cast<int>(e) - half;
  const double first = std::ldexp(1.0, half), second = std::ldexp(1.0, other);
  return (ExpMinusOneNearZero(rest) * first + (first - 1 / second)) * second;
}

}  // namespace cairn
