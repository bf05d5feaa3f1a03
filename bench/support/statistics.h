// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <span>
#include <vector>

namespace cairn::cli {

/// The value of everything that was not measured.
inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// A value that was not measured is NaN; all functions here leave it out, and answer NaN if nothing
/// is left.
std::vector<double> Measured(std::span<const double> values);

/// The smallest value such that a share of at least `share` of all values is no larger (nearest
/// rank): a value that occurred, never one in between. @pre 0 <= share <= 1
double Quantile(std::span<const double> values, double share);
double Median(std::span<const double> values);
double Mean(std::span<const double> values);
double Largest(std::span<const double> values);

}  // namespace cairn::cli
