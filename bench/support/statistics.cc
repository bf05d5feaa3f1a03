// SPDX-License-Identifier: MIT
#include "support/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cairn::cli {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::vector<double> Measured(std::span<const double> values) {
  std::vector<double> result;
  for (double value : values) {
    if (!std::isnan(value)) result.push_back(value);
  }
  return result;
}

double Quantile(std::span<const double> values, double share) {
  std::vector<double> sorted = Measured(values);
  if (sorted.empty()) return kNothing;
  std::sort(sorted.begin(), sorted.end());
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<size_t>(std::max(rank, 1.0)) - 1];
}

double Median(std::span<const double> values) { return Quantile(values, 0.5); }

double Mean(std::span<const double> values) {
  const std::vector<double> all = Measured(values);
  if (all.empty()) return kNothing;
  return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}

double Largest(std::span<const double> values) {
  const std::vector<double> all = Measured(values);
  return all.empty() ? kNothing : *std::max_element(all.begin(), all.end());
}

}  // namespace cairn::cli
