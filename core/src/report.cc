// SPDX-License-Identifier: MIT
#include "cairn/report.h"

#include <array>
#include <charconv>

namespace cairn {
namespace {

/// The shortest text that means this number, in any locale.
std::string Text(double number) {
  std::array<char, 32> text;
  const auto [end, error] = std::to_chars(text.begin(), text.end(), number);
  return {text.begin(), end};
}

}  // namespace

std::string Describe(const BadSetting& bad) {
  return std::string(bad.name) + " is " + Text(bad.value) + ", must be " + bad.range;
}

std::string_view Describe(Status status) {
  switch (status) {
    case Status::kOk:
      return "solved; the reason for stopping says how far";
    case Status::kBadSettings:
      return "a setting is out of its range";
    case Status::kEmptyProblem:
      return "the problem has no bodies";
    case Status::kWrongSize:
      return "the sizes of the problem, its start or its results do not fit one another";
    case Status::kNotFinite:
      return "a number is NaN, or infinite and not a bound";
    case Status::kBadMass:
      return "an inverse mass is negative, or an inverse inertia is not symmetric positive "
             "semidefinite";
    case Status::kNoSuchBody:
      return "a row or manifold names a body that is not there, or the same body twice";
    case Status::kBadBounds:
      return "the lower bound of a row is above its upper bound, or a friction row may not be zero";
    case Status::kBadCompliance:
      return "a compliance is negative, or a relaxation is outside (0, 2)";
    case Status::kBadParent:
      return "the parent of a friction row is not an earlier row of the same two bodies with "
             "bounds of "
             "its own";
    case Status::kBadFriction:
      return "a coefficient of friction or restitution is negative";
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
    case StopReason::kBrokeDown:
      return "broke down";
    case StopReason::kSweepLimit:
      return "sweep limit";
    case StopReason::kTimeSpent:
      return "time spent";
    case StopReason::kWorkSpent:
      return "work spent";
  }
  return "unknown reason";
}

std::string_view Describe(NoStep reason) {
  switch (reason) {
    case NoStep::kNotAsked:
      return "not asked for";
    case NoStep::kEnded:
      return "iteration ended";
    case NoStep::kPaused:
      return "failed of late";
    case NoStep::kTooDear:
      return "too dear";
    case NoStep::kSweepsFaster:
      return "sweeps faster";
  }
  return "unknown reason";
}

std::string Describe(const Report& report) {
  const BadSetting& bad = report.bad_setting;
  if (report.ok()) return std::string(Describe(report.stop));
  std::string where;
  const auto add = [&where](const char* what, int index) {
    if (index >= 0) where = what + std::to_string(index) + ": ";
  };
  add("row ", report.bad_row);
  add("body ", report.bad_body);
  add("manifold ", report.bad_manifold);
  add("joint ", report.bad_joint);
  return bad.name != nullptr ? where.append(Describe(bad)) : where.append(Describe(report.status));
}

}  // namespace cairn
