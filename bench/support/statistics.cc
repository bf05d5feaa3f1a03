// SPDX-License-Identifier: MIT
#include "support/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cairn::cli {
std::vector<double> Measured(std::span<const double> values) {
  std::vector<double> result;
  for (double value : values) {
    if (!std::isnan(value)) result.push_back(value);
  }
  return result;
}

double Quantile(std::span<const double> values, double share) {
  std::vector<double> sorted = Measured(values);
  if (sorted.empty()) return kNotMeasured;
  std::sort(sorted.begin(), sorted.end());
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<size_t>(std::max(rank, 1.0)) - 1];
}

double Median(std::span<const double> values) { return Quantile(values, 0.5); }

double Mean(std::span<const double> values) {
  const std::vector<double> all = Measured(values);
  if (all.empty()) return kNotMeasured;
  return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}

double Largest(std::span<const double> values) {
  const std::vector<double> all = Measured(values);
  return all.empty() ? kNotMeasured : *std::max_element(all.begin(), all.end());
}

}  // namespace cairn::cli
