// SPDX-License-Identifier: MIT
#include "solve/output/solve_output.h"

#include <fmt/format.h>

#include <cmath>

namespace cairn::cli {
namespace {

std::string Cell(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }

/// A reason may hold commas and quotes.
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string LevelCells(const LevelReached& level) {
  if (!level.first) return ",,,";
  return fmt::format(",{},{},{}", Cell(level.first->time), level.first->sweeps,
                     level.first->factorisations);
}

std::string Line(const ProblemResult& problem, const LcpSolverResult& solver,
                 const std::vector<double>& errors) {
  std::string line = fmt::format(
      "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", problem.name, problem.size,
      problem.nonzeros, problem.free_rows, problem.steps, solver.label, solver.failure ? 0 : 1,
      Cell(solver.time), Cell(solver.nested_time), solver.sweeps, solver.factorisations,
      solver.analyses, solver.factor_nonzeros,
      Cell(problem.rows ? solver.residual.max : solver.residual.relative), Cell(solver.error),
      Cell(solver.energy_error), problem.truth_name, problem.rows ? "m/s" : "relative");
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
                            Cell(point.time), point.sweeps, point.factorisations, Cell(point.error),
                            Cell(point.energy_error), Cell(point.residual));
      }
    }
  }
  return text;
}

}  // namespace cairn::cli
