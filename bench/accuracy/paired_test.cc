// SPDX-License-Identifier: MIT
#include "accuracy/paired_test.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace cairn::accuracy {
namespace {

/// Twice the ranks of the sizes of differences that are sorted by size: whole numbers, also where
/// several share their mean.
std::vector<int> DoubleRanks(const std::vector<double>& sorted) {
  std::vector<int> ranks;
  for (size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    while (end < sorted.size() && std::abs(sorted[end]) == std::abs(sorted[begin])) ++end;
    ranks.insert(ranks.end(), end - begin, static_cast<int>(begin + 1 + end));
  }
  return ranks;
}

/// P(a sum of values, each taken with probability 1/2, is <= most).
double ProbabilityOfSum(const std::vector<int>& values, int most) {
  std::vector<double> of_sum(std::accumulate(values.begin(), values.end(), 1), 0.0);
  of_sum[0] = 1;
  int reached = 0;
  for (const int value : values) {
    reached += value;
    for (int sum = reached; sum >= 0; --sum) {
      of_sum[sum] = 0.5 * (of_sum[sum] + (sum >= value ? of_sum[sum - value] : 0));
    }
  }
  return std::accumulate(of_sum.begin(), of_sum.begin() + most + 1, 0.0);
}

}  // namespace

PairedTest ComparePaired(std::span<const double> first, std::span<const double> second) {
  PairedTest result;
  std::vector<double> differences;
  for (size_t i = 0; i < first.size(); ++i) {
    if (std::isnan(first[i]) || std::isnan(second[i])) continue;
    if (first[i] == second[i]) {
      ++result.equal;
    } else {
      differences.push_back(first[i] - second[i]);
      ++(first[i] < second[i] ? result.less : result.more);
    }
  }
  std::sort(differences.begin(), differences.end(),
            [](double a, double b) { return std::abs(a) < std::abs(b); });
  const std::vector<int> ranks = DoubleRanks(differences);
  int sum_less = 0, sum_more = 0;
  for (size_t i = 0; i < ranks.size(); ++i) (differences[i] < 0 ? sum_less : sum_more) += ranks[i];
  result.p = std::min(1.0, 2 * ProbabilityOfSum(ranks, std::min(sum_less, sum_more)));
  return result;
}

std::vector<double> HolmAdjusted(std::span<const double> p) {
  std::vector<size_t> order(p.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [p](size_t a, size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double largest = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    const double left = static_cast<double>(order.size() - i);
    largest = std::max(largest, std::min(1.0, left * p[order[i]]));
    adjusted[order[i]] = largest;
  }
  return adjusted;
}

}  // namespace cairn::accuracy
