// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "support/command.h"
#include "support/progress.h"

namespace cairn::cli {

/// Takes `--float64` and `--precision P` out of the arguments.
/// @return the precision asked for, or "" if none was. @throws Failure (kUsage)
std::string TakePrecision(std::vector<std::string>* arguments);

/// A program and its arguments as they can be shown to others: of paths, only the last part.
std::string WithoutPaths(std::string_view program, const std::vector<std::string>& arguments);

/// A whole number. @throws Failure (kUsage) if it is none, or not in [least, most]; `meaning` says
/// in the message what the option is.
long long ParseCount(std::string_view option, std::string_view text, long long least,
                     long long most, std::string_view meaning);

/// The same as an int. @pre both ends are ints
int ParseInt(std::string_view option, std::string_view text, long long least, long long most,
             std::string_view meaning);

/// A number in [least, most], "0.5" or "1e-6". @throws Failure (kUsage) likewise.
double ParseNumber(std::string_view option, std::string_view text, double least, double most,
                   std::string_view meaning);

/// When progress is shown. @throws Failure (kUsage)
ProgressMode ParseProgress(const OutputWords& words);

}  // namespace cairn::cli
