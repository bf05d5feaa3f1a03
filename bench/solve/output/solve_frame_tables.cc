// SPDX-License-Identifier: MIT
#include "solve/output/solve_frame_tables.h"

#include <fmt/format.h>

#include <algorithm>

#include "solve/output/solve_columns.h"

namespace cairn::cli {
namespace {

constexpr double kTimes[] = {0.05, 0.1, 0.2, 0.5, 1, 2, 4, 8, 16, 33, 100, 1000, 10000};

std::string Steps(const LcpSolverResult& solver) {
  if (solver.steps_accepted + solver.steps_restored == 0) return "-";
  return fmt::format("{} / {}", solver.steps_accepted, solver.steps_restored);
}

std::string FrameEnded(const LcpSolverResult& solver) {
  if (!solver.failure) return solver.stop;
  return fmt::format("NOT: {}", solver.stop);
}

/// What was measured at kTimes of every solver.
TextTable TimeTable(const SolveResult& result, const char* what, double HistoryPoint::*value) {
  TextTable table = NamedTable(result, ProblemKind::kFrame);
  const std::vector<double> times = TimesOfErrors(result);
  for (const double time : times) {
    table.columns.push_back({fmt::format("{:g} ms", time), what});
  }
  if (times.empty()) return table;
  AddRows(result, ProblemKind::kFrame, &table,
          [&](const ProblemResult&, const LcpSolverResult& solver, auto* row) {
            for (const double time : times) {
              const HistoryPoint* const point = PointAt(solver, time);
              row->push_back(point == nullptr ? "-" : FormatNumber(point->*value));
            }
          });
  return table;
}

/// Who got closer to the laws of the rows than the reference did; empty if nobody.
std::string BetterThanReference(const ProblemResult& problem) {
  for (const LcpSolverResult& solver : problem.solvers) {
    if (!(solver.residual.max < problem.best_residual)) continue;
    return fmt::format(";\n{} has a smaller residual than that, {} m/s", solver.label,
                       FormatNumber(solver.residual.max));
  }
  return "";
}

std::string ReferenceText(const ProblemResult& problem) {
  if (problem.truth == ErrorMeter::Truth::kNone) return "errors: not measured";
  const std::string residual =
      fmt::format("residual {} m/s, another start ends {} m/s away",
                  FormatNumber(problem.best_residual), FormatNumber(problem.rows->spread));
  if (problem.truth == ErrorMeter::Truth::kConverged) {
    return fmt::format("errors: of velocities, against a converged reference ({})", residual);
  }
  // where the worst row is that close, no game sees the rest
  constexpr double kAlmost = 1e-5;  // [m/s]
  if (problem.best_residual <= kAlmost) {
    return fmt::format("errors: of velocities, against a reference that almost converged ({}){}",
                       residual, BetterThanReference(problem));
  }
  return fmt::format(
      "errors: no reference converged, so they are against where it ended ({});\nerrors that are "
      "not much larger than that say little{}",
      residual, BetterThanReference(problem));
}

}  // namespace

const HistoryPoint* PointAt(const LcpSolverResult& solver, double time) {
  const HistoryPoint* last = nullptr;
  for (const HistoryPoint& point : solver.history) {
    if (point.time <= time) last = &point;
  }
  return last;
}

std::vector<double> TimesOfErrors(const SolveResult& result) {
  double longest = 0;
  for (const ProblemResult& problem : result.problems) {
    if (!problem.rows) continue;
    for (const LcpSolverResult& solver : problem.solvers) {
      if (!solver.history.empty()) longest = std::max(longest, solver.history.back().time);
    }
  }
  std::vector<double> times;
  for (const double time : kTimes) {
    if (time <= longest) times.push_back(time);
  }
  return times;
}

std::string FrameHeading(const ProblemResult& problem) {
  const RowFacts& facts = *problem.rows;
  std::string text =
      fmt::format("{}: {} bodies, {} rows ({} of joints and others, {} contacts)", problem.name,
                  facts.bodies, problem.size, facts.joint_rows, facts.points);
  if (facts.limited_sweeps > 0) {
    text += fmt::format("\nrecorded with {} iterations, a limit that is lifted here",
                        facts.limited_sweeps);
  }
  if (!problem.source.empty()) text += fmt::format("\nsource: {}", problem.source);
  return fmt::format("{}\n{}\n", text, ReferenceText(problem));
}

TextTable FrameWorkTable(const SolveResult& result) {
  const bool errors = AnyErrors(result, ProblemKind::kFrame);
  TextTable table = NamedTable(result, ProblemKind::kFrame);
  table.columns.push_back({"time", "ms"});
  table.columns.push_back({"prepared", "ms"});
  for (const char* name : {"sweeps", "factorised"}) table.columns.push_back({name, ""});
  table.columns.push_back({"steps", "kept/undone"});
  table.columns.push_back({"residual", "m/s"});
  if (errors) {
    table.columns.push_back({"error", "m/s"});
    table.columns.push_back({"error rms", "m/s"});
    table.columns.push_back({"of", ""});
  }
  table.columns.push_back({"end", ""});
  AddRows(result, ProblemKind::kFrame, &table,
          [errors](const ProblemResult& problem, const LcpSolverResult& solver, auto* row) {
            row->push_back(FormatTime(solver.time));
            row->push_back(FormatTime(solver.prepare_time));
            row->push_back(FormatCount(solver.sweeps));
            row->push_back(FormatCount(solver.factorisations));
            row->push_back(Steps(solver));
            row->push_back(FormatNumber(solver.residual.max));
            if (errors) AddErrorCells(problem, solver, row);
            row->push_back(FrameEnded(solver));
          });
  return table;
}

TextTable FrameLevelTable(const SolveResult& result) {
  TextTable table = NamedTable(result, ProblemKind::kFrame);
  if (result.errors.empty()) return table;
  for (const char* of : {"error", "residual"}) {
    for (const double level : result.errors) {
      table.columns.push_back({fmt::format("{} {:g}", of, level), "ms"});
    }
  }
  AddRows(result, ProblemKind::kFrame, &table,
          [&](const ProblemResult&, const LcpSolverResult& solver, auto* row) {
            for (const auto* levels : {&solver.levels, &solver.residual_levels}) {
              for (size_t i = 0; i < result.errors.size(); ++i) {
                const bool reached = i < levels->size() && (*levels)[i].first;
                row->push_back(reached ? FormatTime((*levels)[i].first->time) : "-");
              }
            }
          });
  return table;
}

TextTable FrameErrorTable(const SolveResult& result) {
  if (!AnyErrors(result, ProblemKind::kFrame)) return {};
  return TimeTable(result, "error, m/s", &HistoryPoint::error);
}

TextTable FrameResidualTable(const SolveResult& result) {
  return TimeTable(result, "residual", &HistoryPoint::residual);
}

std::string FrameReadingHelp(const SolveResult& result) {
  std::string help =
      "Recorded frames. time: of the solver alone, from the recorded start; of Cairn's solvers "
      "the\n"
      "whole call, with a solver that knows nothing of the frames before. prepared: the frame "
      "into\n"
      "the memory of the solver, before time begins. residual: natural, of the row that is "
      "furthest\n"
      "from its law.\n";
  if (AnyErrors(result, ProblemKind::kFrame)) {
    help +=
        "error: of velocities against the reference, the centre of mass that is furthest off; rms: "
        "of all\nmomenta. error 0.1, residual 0.1: the first time they were that small. 1 ms and "
        "so "
        "on: what they\nwere when so much time was spent.\n";
  }
  return help;
}

}  // namespace cairn::cli
