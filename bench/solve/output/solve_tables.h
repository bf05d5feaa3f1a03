// SPDX-License-Identifier: MIT
#pragma once

#include <string>

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

}  // namespace cairn::cli
