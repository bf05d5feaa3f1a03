// SPDX-License-Identifier: MIT
#include "solve/output/solve_output.h"

#include <fmt/format.h>

#include "support/text_table.h"

namespace cairn::cli {
namespace {

/// A reason may hold commas and quotes.
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string LevelCells(const LevelReached& level) {
  if (!level.first) return ",,,";
  return fmt::format(",{},{},{}", FormatCell(level.first->time), level.first->sweeps,
                     level.first->factorisations);
}

std::string Line(const ProblemResult& problem, const LcpSolverResult& solver,
                 const std::vector<double>& errors) {
  std::string line =
      fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", problem.name,
                  problem.size, problem.nonzeros, problem.free_rows, problem.steps, solver.label,
                  solver.failure ? 0 : 1, FormatCell(solver.time), FormatCell(solver.nested_time),
                  solver.sweeps, solver.factorisations, solver.analyses, solver.factor_nonzeros,
                  FormatCell(problem.rows ? solver.residual.max : solver.residual.relative),
                  FormatCell(solver.error), FormatCell(solver.energy_error), problem.truth_name,
                  problem.rows ? "m/s" : "relative");
  for (size_t i = 0; i < errors.size(); ++i) {
    line += i < solver.levels.size() ? LevelCells(solver.levels[i]) : ",,,";
  }
  return line + "," + Quoted(solver.failure.value_or("")) + "\n";
}

}  // namespace

std::string ToCsv(const SolveResult& result) {
  std::string text =
      "problem,n,nonzeros,free_rows,steps,solver,solved,time_ms,nested_ms,sweeps,factorisations,"
      "analyses,factor_nonzeros,residual,error,error_energy,error_of,unit";
  for (const double error : result.errors) {
    text += fmt::format(",to_{0:g}_ms,to_{0:g}_sweeps,to_{0:g}_factorisations", error);
  }
  text += ",failure\n";
  for (const ProblemResult& problem : result.problems) {
    for (const LcpSolverResult& solver : problem.solvers) {
      text += Line(problem, solver, result.errors);
    }
  }
  return text;
}

std::string HistoryToCsv(const SolveResult& result) {
  std::string text = "problem,solver,time_ms,sweeps,factorisations,error,error_energy,residual\n";
  for (const ProblemResult& problem : result.problems) {
    for (const LcpSolverResult& solver : problem.solvers) {
      for (const HistoryPoint& point : solver.history) {
        text += fmt::format("{},{},{},{},{},{},{},{}\n", problem.name, solver.label,
                            FormatCell(point.time), point.sweeps, point.factorisations,
                            FormatCell(point.error), FormatCell(point.energy_error),
                            FormatCell(point.residual));
      }
    }
  }
  return text;
}

}  // namespace cairn::cli
