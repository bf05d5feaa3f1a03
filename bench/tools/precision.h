// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cairn::cli {

/// The tool is built twice, once for each precision of Bullet: a process that loads both crashes.

/// "float" or "float64": of this program.
std::string OwnPrecision();

/// The path of the program for a precision beside this one; none if it was not built.
std::optional<std::string> FindSibling(const std::string& precision);

/// Goes on as the program for `precision` with these arguments (the name of the program not among
/// them). Does not come back. @throws Failure (kBadInput) if there is no such program.
[[noreturn]] void ContinueAs(const std::string& precision,
                             const std::vector<std::string>& arguments);

/// Goes on as cairn-play, the window, a program of its own: this one loads no graphics. Does not
/// come back. @throws Failure if there is no such program, or this one is not of floats
[[noreturn]] void ContinueAsPlay(const std::vector<std::string>& arguments);

/// The first line that a program writes to stdout; empty if it cannot be run.
std::string FirstLineOf(const std::string& program, const std::string& arguments);

}  // namespace cairn::cli
