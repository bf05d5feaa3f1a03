// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "solve/problem_choice.h"
#include "solve/solve_result.h"

namespace cairn::cli {

/// Makes the folder, if need be. @throws Failure (kBadInput) if nothing can be written there; asked
/// before a long run.
void CheckFolder(const std::string& folder);

/// Writes <folder>/<problem>/<solver>/x.mtx and w.mtx, Matrix Market arrays; of a march, the last
/// problem. @throws Failure (kBadInput)
void WriteSolutions(const std::string& folder, const SolveResult& result);

/// Writes <folder>/<problem> as ReadProblemFolder() reads it; of a march, the first problem.
/// @throws Failure (kBadInput)
void WriteProblems(const std::string& folder, std::span<const ProblemChoice> choices);

}  // namespace cairn::cli
