// SPDX-License-Identifier: MIT
#include "accuracy/intervals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/statistics.h"

namespace cairn::accuracy {
namespace {

/// How many of n sorted values may be cut off at each end: the largest k with
/// P(Binomial(n, 1/2) < k) <= 2.5 %.
size_t RanksCut(size_t n) {
  double probability = std::pow(0.5, static_cast<double>(n)), below = probability;
  size_t cut = 0;
  while (below <= 0.025) {
    ++cut;
    probability *= static_cast<double>(n - cut + 1) / static_cast<double>(cut);
    below += probability;
  }
  return cut;
}

}  // namespace

Interval MedianInterval(std::span<const double> values) {
  std::vector<double> sorted = cli::Measured(values);
  const double median = cli::Median(sorted);
  if (sorted.empty()) return {median, median, median};
  std::sort(sorted.begin(), sorted.end());
  const size_t cut = RanksCut(sorted.size());
  // the interval reaches from the cut-th value to the cut-th from above, counted from 1
  const size_t at = cut > 0 ? cut - 1 : 0;
  return {median, sorted[at], sorted[sorted.size() - 1 - at]};
}

Interval ShareInterval(int hits, int count) {
  constexpr double z = 1.959964;  // of the normal distribution, 97.5 %
  const double n = count, p = hits / n, z2 = z * z / n;
  const double middle = (p + z2 / 2) / (1 + z2);
  const double half = std::sqrt(z2 * (p * (1 - p) + z2 / 4)) / (1 + z2);
  return {p, std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

}  // namespace cairn::accuracy
