// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cairn::cli {

/// Who takes solvers by name; `cairn record` and `cairn play` as `cairn run` does.
enum class SolverUser { kRun, kWorlds, kSolve };

/// What other commands call a solver of this one.
std::vector<std::string> Aliases(SolverUser user, std::string_view name);

/// Solvers with commas between them, "bullet-si@50,pgs-sm", by the names that this command has for
/// them: names of other commands, and beginnings of names, are taken for what they mean.
/// @throws Failure (kUsage) for a name that is of another command alone, or of none
std::string OwnSolverNames(SolverUser user, std::string_view list);

}  // namespace cairn::cli
