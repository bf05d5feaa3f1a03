// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cairn::cli {

/// Changes of one letter (insert, delete, replace, swap two neighbours) that make `b` of `a`.
int EditDistance(std::string_view a, std::string_view b);

/// "did you mean 'castle'? " with the name nearest to `word`, or nothing if none is close: up to a
/// third of its letters may be wrong, dashes before an option not counted.
std::string DidYouMean(std::string_view word, std::span<const std::string> names);

/// The index of the name that a user means by `word`: the name itself, or a prefix that no other
/// name has.
/// @param kind  what the names are, for the message: "scene", "solver", "command"
/// @param help  how to see all names, for the message
/// @throws Failure (kUsage) with the nearest name, if one is close.
size_t FindName(std::string_view kind, std::string_view word, std::span<const std::string> names,
                std::string_view help);

/// Parts of a text between separators; empty parts are left out.
std::vector<std::string> Split(std::string_view text, char separator);

}  // namespace cairn::cli
