// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "run/result.h"
#include "support/text_table.h"

namespace cairn::cli {

/// Time and error of each solver.
TextTable PerformanceTable(const SceneResult& scene, const RunResult& run);
/// What became of the scene, and what the solvers did inside.
TextTable FactsTable(const SceneResult& scene, const RunResult& run);

/// One line that says what was simulated.
std::string SceneHeading(const SceneResult& scene, const RunResult& run);
/// How often and on what the solvers ran, in half a sentence.
std::string DescribeRun(const RunResult& run);
/// How to read the tables, a few lines of at most 110 columns.
std::string ReadingHelp(const RunResult& run);

/// The whole result for a terminal, and as Markdown.
std::string ToText(const RunResult& run);
std::string ToMarkdown(const RunResult& run);

/// One line per scene, solver and frame under one line of names. What was not measured is empty.
std::string ToCsv(const RunResult& run);

/// The whole result, "schema_version": 1: `context` says where and how it was made, `scenes` holds
/// for each solver its summary and arrays with one value per frame. What was not measured is null.
/// docs/run.schema.json describes it.
std::string ToJson(const RunResult& run);

/// The timelines of a run in the trace event format of Chrome, which ui.perfetto.dev and
/// chrome://tracing open: a process for each solver and scene, a thread for each worker.
std::string ToTrace(const RunResult& run);

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

/// Scenes of which scaling was measured: ns for each row of a solve, with every number of threads
/// and every instruction set. Without rows if there is none.
TextTable ScalingTable(const RunResult& run);

/// The columns after scene and rows: "1 thread", "2 threads", "avx2" ...
std::vector<std::string> ScalingNames(const RunResult& run);

}  // namespace cairn::cli
