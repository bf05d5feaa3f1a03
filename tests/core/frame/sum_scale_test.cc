// SPDX-License-Identifier: MIT
#include "sweep/sum_scale.h"

#include <gtest/gtest.h>

#include <limits>

namespace cairn {
namespace {

// Also at the ends of what doubles hold.
TEST(SumScale, BringsTheLargestNumberToSoManyBits) {
  for (const int bits : {30, 36}) {
    for (int exponent = -1074; exponent < 1024; ++exponent) {
      for (const double mantissa : {1.0, 1.5, 1.999}) {
        const double largest = std::ldexp(mantissa, exponent);
        if (largest == 0) continue;
        EXPECT_EQ(SumScale(largest, bits), std::ldexp(1.0, bits - 1 - std::ilogb(largest)))
            << exponent;
      }
    }
  }
}

TEST(SumScale, IsOneWhereThereIsNothingToScale) {
  using Limits = std::numeric_limits<double>;
  for (const double largest : {0.0, -0.0, -1.0, Limits::infinity(), Limits::quiet_NaN()}) {
    EXPECT_EQ(SumScale(largest, 30), 1);
  }
}

}  // namespace
}  // namespace cairn
