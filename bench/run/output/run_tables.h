// SPDX-License-Identifier: MIT
#pragma once

#include <string>

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

}  // namespace cairn::cli
