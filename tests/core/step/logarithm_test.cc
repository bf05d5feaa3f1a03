// SPDX-License-Identifier: MIT
#include "runtime/logarithm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace cairn {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

TEST(Logarithm, IsThatOfTheCLibraryButForItsLastDigits) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100000; ++i) {
    const int exponent = static_cast<int>(random() % 2000) - 1000;
    const double mantissa = 1 + static_cast<double>(random() % 1000000) / 1000000;
    const double x = std::ldexp(mantissa, i % 2 == 0 ? exponent : exponent / 500);
    const double expected = std::log(x);
    EXPECT_NEAR(Log(x), expected, 3 * kEpsilon * std::abs(expected)) << x;
  }
}

TEST(Logarithm, IsExactWhereItCanBe) {
  EXPECT_EQ(Log(1), 0);
  EXPECT_EQ(Log(2), 0x1.62e42fefa39efp-1);
  EXPECT_EQ(Log(0), -kInfinity);
  EXPECT_EQ(Log(kInfinity), kInfinity);
  EXPECT_TRUE(std::isnan(Log(-1)));
  EXPECT_TRUE(std::isnan(Log(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_NEAR(Log(std::numeric_limits<double>::denorm_min()), -1074 * std::log(2), 1e-12);
}

TEST(ExpMinusOneTest, IsThatOfTheCLibraryButForItsLastDigits) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 100000; ++i) {
    const double size = std::ldexp(1 + static_cast<double>(random() % 1000000) / 1000000,
                                   static_cast<int>(random() % 40) - 30);
    const double x = i % 2 == 0 ? size : -size;
    const double expected = std::expm1(x);
    if (std::isinf(expected)) {
      EXPECT_EQ(ExpMinusOne(x), expected) << x;
    } else {
      EXPECT_NEAR(ExpMinusOne(x), expected, 4 * kEpsilon * std::abs(expected)) << x;
    }
  }
}

TEST(ExpMinusOneTest, EndsWhereNumbersEnd) {
  EXPECT_EQ(ExpMinusOne(0), 0);
  EXPECT_EQ(ExpMinusOne(-kInfinity), -1);
  EXPECT_EQ(ExpMinusOne(kInfinity), kInfinity);
  EXPECT_EQ(ExpMinusOne(1000), kInfinity);
  EXPECT_EQ(ExpMinusOne(-1000), -1);
  EXPECT_TRUE(std::isnan(ExpMinusOne(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace cairn
