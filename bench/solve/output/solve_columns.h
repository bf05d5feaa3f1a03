// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "solve/solve_result.h"
#include "support/text_table.h"

namespace cairn::cli {

/// What a table is about; each kind has tables of its own.
enum class ProblemKind { kMatrix, kFrame };

inline bool IsOf(ProblemKind kind, const ProblemResult& problem) {
  return problem.rows.has_value() == (kind == ProblemKind::kFrame);
}

/// A table of the columns that say which problem and solver a row is about.
inline TextTable NamedTable(const SolveResult& result, ProblemKind kind) {
  TextTable table;
  if (result.problems.size() > 1) {
    table.columns.push_back({kind == ProblemKind::kFrame ? "frame" : "problem", ""});
  }
  table.columns.push_back({"solver", ""});
  table.names = table.columns.size();
  return table;
}

/// The cells of those columns.
inline std::vector<std::string> NameCells(const SolveResult& result, const ProblemResult& problem,
                                          const LcpSolverResult& solver) {
  if (result.problems.size() == 1) return {solver.label};
  return {problem.name, solver.label};
}

/// A row for each problem of a kind and each solver; `cells` appends what is behind the names.
template <class Cells>
void AddRows(const SolveResult& result, ProblemKind kind, TextTable* table, const Cells& cells) {
  for (const ProblemResult& problem : result.problems) {
    if (!IsOf(kind, problem)) continue;
    for (const LcpSolverResult& solver : problem.solvers) {
      std::vector<std::string> row = NameCells(result, problem, solver);
      cells(problem, solver, &row);
      table->rows.push_back(std::move(row));
    }
  }
}

/// Whether errors of some problem of the kind are known.
inline bool AnyErrors(const SolveResult& result, ProblemKind kind) {
  return std::any_of(result.problems.begin(), result.problems.end(), [kind](const auto& problem) {
    return IsOf(kind, problem) && problem.truth != ErrorMeter::Truth::kNone;
  });
}

/// Two errors, and against what.
inline void AddErrorCells(const ProblemResult& problem, const LcpSolverResult& solver,
                          std::vector<std::string>* row) {
  row->push_back(FormatNumber(solver.error));
  row->push_back(FormatNumber(solver.energy_error));
  row->push_back(problem.truth_name);
}

}  // namespace cairn::cli
