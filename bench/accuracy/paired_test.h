// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

namespace cairn::accuracy {

/// What pairs of values say about which of two is smaller.
struct PairedTest {
  int less = 0, more = 0, equal = 0;  ///< Pairs in which the first value is less, more, the same.
  double p = 1;  ///< Two-sided, of Wilcoxon's signed-rank test: that there is no difference.
};

/// Wilcoxon, "Individual comparisons by ranking methods", 1945, with the exact distribution given
/// the ranks; equal differences share their mean rank. Pairs that are equal, also both infinite,
/// are left out of p, those with a NaN out of everything. @pre as many values in both
PairedTest ComparePaired(std::span<const double> first, std::span<const double> second);

/// p-values such that calling those below a level significant is wrong with no more than that
/// probability in any of them: Holm, "A simple sequentially rejective multiple test procedure",
/// 1979. In the order in which they came.
std::vector<double> HolmAdjusted(std::span<const double> p);

}  // namespace cairn::accuracy
