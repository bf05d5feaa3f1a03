// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace cairn::accuracy {

/// A figure with its 95 % confidence interval.
struct Interval {
  double value = 0, low = 0, high = 0;
};

/// The median, and order statistics around it that hold the true one with at least 95 %, whatever
/// the distribution: binomial probabilities of the ranks. Of fewer than 6 values the smallest and
/// the largest, which is less. NaN values are left out, and are the answer if nothing is left.
Interval MedianInterval(std::span<const double> values);

/// A share of `count` trials, with the interval of Wilson, "Probable inference, the law of
/// succession, and statistical inference", 1927. @pre 0 <= hits <= count; count > 0
Interval ShareInterval(int hits, int count);

}  // namespace cairn::accuracy
