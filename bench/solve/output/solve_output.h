// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "solve/problem_choice.h"
#include "solve/solve_result.h"
#include "support/text_table.h"

namespace cairn::cli {

/// A row for each problem and solver: time, work, residual, error and why it ended.
TextTable WorkTable(const SolveResult& result);
/// A row likewise: time and work until the errors asked for. No rows if none were measured.
TextTable ErrorTable(const SolveResult& result);
/// A row for each problem, solver and number that is known. Often none.
TextTable AnswerTable(const SolveResult& result);
/// Where the time went; without rows unless it was asked for.
TextTable PhaseTable(const SolveResult& result);

/// What was solved, one line for a problem on its own.
std::string Heading(const SolveResult& result);
/// A line for each solver: how many were solved, and why the others were not.
std::string SolvedSummary(const SolveResult& result);
/// How to read the tables, lines of at most 110 columns.
std::string ReadingHelp(const SolveResult& result);

/// The whole result for a terminal, and as Markdown.
std::string ToText(const SolveResult& result);
std::string ToMarkdown(const SolveResult& result);

/// A line for each problem and solver. Cells of what was not measured are empty.
std::string ToCsv(const SolveResult& result);

/// A line for each iterate that was kept: error over time.
std::string HistoryToCsv(const SolveResult& result);

/// The whole result, "schema_version": 1: `context` says where and how it was made, `settings` what
/// the solvers were told, `problems` holds what was measured for each solver. What was not is null.
std::string ToJson(const SolveResult& result);

/// A picture that stands alone (SVG): for each problem, error over time, or the residual where no
/// error was measured.
std::string ToSvg(const SolveResult& result);

/// Writes <folder>/<problem>/<solver>/x.mtx and w.mtx, Matrix Market arrays; of a march, the last
/// problem. @throws Failure (kBadInput)
void WriteSolutions(const std::string& folder, const SolveResult& result);

/// What to do with a problem that is there already.
enum class IfThere { kRefuse, kOverwrite };

/// Writes <folder>/<problem> as ReadProblemFolder() reads it; of a march, the first problem.
/// @throws Failure (kBadInput) if it cannot be written, or is there already, before any is written;
/// (kUsage) if two problems have the same name
void WriteProblems(const std::string& folder, std::span<const ProblemChoice> choices,
                   IfThere if_there);

}  // namespace cairn::cli
