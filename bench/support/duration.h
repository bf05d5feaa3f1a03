// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace cairn::cli {

/// A time such as "2ms", "500us", "0.002s" or "250000ns".
/// @throws Failure (kUsage) if it is not a positive time of at most a minute; `option` is named in
/// the message.
std::chrono::nanoseconds ParseDuration(std::string_view option, std::string_view text);

/// "2 ms", "500 us": the largest unit in which the number is at least 1.
std::string FormatDuration(std::chrono::nanoseconds time);

/// [ms]
double Milliseconds(std::chrono::nanoseconds time);

}  // namespace cairn::cli
