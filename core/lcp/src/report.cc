// SPDX-License-Identifier: MIT
#include "cairn/lcp/solver.h"

namespace cairn::lcp {

std::string_view Describe(Status status) {
  switch (status) {
    case Status::kOk:
      return "solved; the reason for stopping says how far";
    case Status::kBadSettings:
      return "a setting is out of its range";
    case Status::kWrongSize:
      return "the sizes of the problem, its start or its results do not fit one another";
    case Status::kNotFinite:
      return "a number is NaN, or infinite and not a bound";
    case Status::kBadBounds:
      return "the lower bound of a row is above its upper bound";
    case Status::kBadDiagonal:
      return "a diagonal entry of the matrix is missing, zero or negative";
    case Status::kNotSymmetric:
      return "the matrix is not symmetric";
    case Status::kNotPositiveDefinite:
      return "the matrix is not positive definite: no minimum, or none that this method finds";
    case Status::kOverflow:
      return "the numbers are so large, or so far apart, that the result is not finite";
  }
  return "unknown status";
}

std::string_view Describe(StopReason reason) {
  switch (reason) {
    case StopReason::kNotStarted:
      return "not started";
    case StopReason::kConverged:
      return "converged";
    case StopReason::kStationary:
      return "stationary";
    case StopReason::kStalled:
      return "stalled at rounding";
    case StopReason::kBrokeDown:
      return "broke down";
    case StopReason::kCancelled:
      return "cancelled";
    case StopReason::kSweepLimit:
      return "sweep limit";
    case StopReason::kTimeSpent:
      return "time spent";
    case StopReason::kWorkSpent:
      return "work spent";
  }
  return "unknown reason";
}

std::string Describe(const Report& report) {
  if (report.bad_setting.name != nullptr) return Describe(report.bad_setting);
  if (report.ok()) return std::string(Describe(report.stop));
  const std::string row =
      report.bad_row >= 0 ? "row " + std::to_string(report.bad_row) + ": " : std::string();
  return row + std::string(Describe(report.status));
}

}  // namespace cairn::lcp
