// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cairn::cli {

/// A time such as "2ms", "500us", "0.002s" or "250000ns".
/// @throws Failure (kUsage) if it is not a positive time of at most a minute; `option` is named in
/// the message.
std::chrono::nanoseconds ParseDuration(std::string_view option, std::string_view text);

/// What a frame may cost: a time, or work. Neither: as much as it takes.
struct FrameBudget {
  std::optional<std::chrono::nanoseconds> time;
  std::optional<std::int64_t> units;  ///< Of Budget::Work.
};

/// A time as above, or work such as "100000units".
/// @throws Failure (kUsage)
FrameBudget ParseBudget(std::string_view option, std::string_view text);

/// "2 ms", "100000 units"; "no budget" for neither.
std::string FormatBudget(const FrameBudget& budget);

/// "2 ms", "500 us": the largest unit in which the number is at least 1.
std::string FormatDuration(std::chrono::nanoseconds time);

/// [ms]
double Milliseconds(std::chrono::nanoseconds time);

}  // namespace cairn::cli
