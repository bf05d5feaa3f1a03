// SPDX-License-Identifier: MIT
#include "support/duration.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "support/failure.h"

namespace cairn::cli {
namespace {

struct Unit {
  std::string_view name;
  double nanoseconds;
};
constexpr Unit kUnits[] = {{"s", 1e9}, {"ms", 1e6}, {"us", 1e3}, {"ns", 1}};
constexpr double kMostNanoseconds = 60e9;

/// What may be written: a time, or work, too.
enum class Allowed { kTime, kTimeOrWork };

std::chrono::nanoseconds ParseTime(std::string_view option, std::string_view text,
                                   Allowed allowed) {
  const auto refuse = [&](std::string_view why) -> Failure {
    return {kUsage, fmt::format("{} '{}': {}; write a time such as 2ms, 500us or 0.002s (more than "
                                "0, at most 60s){}",
                                option, text, why,
                                allowed == Allowed::kTime ? "" : ", or work such as 100000units")};
  };
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{}) throw refuse("does not start with a number");
  const std::string_view name(rest, end - rest);
  if (name.empty()) throw refuse("has no unit");
  for (const Unit& unit : kUnits) {
    if (unit.name != name) continue;
    const double nanoseconds = number * unit.nanoseconds;
    if (!(nanoseconds >= 1)) throw refuse("is not more than 0");
    if (!(nanoseconds <= kMostNanoseconds)) throw refuse("is too long");
    return std::chrono::nanoseconds(std::llround(nanoseconds));
  }
  throw refuse(fmt::format("'{}' is not one of the units s, ms, us, ns", name));
}

}  // namespace

std::chrono::nanoseconds ParseDuration(std::string_view option, std::string_view text) {
  return ParseTime(option, text, Allowed::kTime);
}

FrameBudget ParseBudget(std::string_view option, std::string_view text) {
  constexpr std::string_view kUnit = "units";
  constexpr std::int64_t kMostUnits = 1'000'000'000'000;
  if (!text.ends_with(kUnit)) {
    return {.time = ParseTime(option, text, Allowed::kTimeOrWork), .units = {}};
  }
  std::int64_t units = 0;
  const char* const end = text.data() + text.size() - kUnit.size();
  const auto [rest, error] = std::from_chars(text.data(), end, units);
  if (error != std::errc{} || rest != end || units < 1 || units > kMostUnits) {
    throw Failure(kUsage, fmt::format("{} '{}': write a whole number of units from 1 to {}, such "
                                      "as 100000units",
                                      option, text, kMostUnits));
  }
  return {.time = {}, .units = units};
}

std::string FormatBudget(const FrameBudget& budget) {
  if (budget.units) return fmt::format("{} units", *budget.units);
  return budget.time ? FormatDuration(*budget.time) : "no budget";
}

std::string FormatDuration(std::chrono::nanoseconds time) {
  const double nanoseconds = static_cast<double>(time.count());
  for (const Unit& unit : kUnits) {
    if (nanoseconds >= unit.nanoseconds) {
      return fmt::format("{:g} {}", nanoseconds / unit.nanoseconds, unit.name);
    }
  }
  return "0 s";
}

double Milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

}  // namespace cairn::cli
