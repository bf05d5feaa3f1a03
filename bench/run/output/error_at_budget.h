// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "run/result.h"
#include "support/text_table.h"

namespace cairn::cli {

/// Times that a frame may take [ms], ascending: those of usual frame rates, and the budget of the
/// run.
std::vector<double> FixedBudgets(const RunResult& run);

/// Median over the samples of the error of the greatest effort that took at most `budget` [ms];
/// NaN if on any sample none did, or nothing was measured.
double ErrorAtBudget(const SolverResult& solver, double budget);

/// ErrorAtBudget() of every kind of solver. Without rows if nothing was measured.
TextTable BudgetTable(const SceneResult& scene, const RunResult& run);

/// Which solver to use at the budget of the run, and at which budgets Cairn does not help; a
/// sentence or two.
std::string Advice(const SceneResult& scene, const RunResult& run);

}  // namespace cairn::cli
