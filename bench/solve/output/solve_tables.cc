// SPDX-License-Identifier: MIT
#include "solve/output/solve_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "solve/output/solve_columns.h"
#include "solve/output/solve_frame_tables.h"
#include "support/duration.h"
#include "support/phase_names.h"
#include "support/text_table.h"

namespace cairn::cli {
namespace {

/// Problems named in a line of the summary; more are counted only.
constexpr size_t kNamedProblems = 4;
/// Residual of a best point above which errors against it are not to be trusted: a hundredth of the
/// smallest error that is asked for by default.
constexpr double kUsableReference = 1e-8;

bool IsSingle(const SolveResult& result) { return result.problems.size() == 1; }

/// "340", or "15 + 3" with factorisations.
std::string EffortText(const HistoryPoint& point) {
  if (point.factorisations == 0) return fmt::format("{}", point.sweeps);
  return fmt::format("{} + {}", point.sweeps, point.factorisations);
}

std::string Ended(const LcpSolverResult& solver) {
  if (!solver.failure) return "solved";
  return solver.stop == "converged" ? "NOT SOLVED" : fmt::format("NOT: {}", solver.stop);
}

/// How good the best point is; a bad one has to be said loudly.
std::string BestRemark(double residual) {
  const std::string text = fmt::format(" (residual {})", FormatNumber(residual));
  if (residual <= kUsableReference) return text;
  return text + ":\nno good reference was found, and errors say little";
}

std::string TruthText(const ProblemResult& problem) {
  switch (problem.truth) {
    case ErrorMeter::Truth::kNone:
      return problem.steps > 1 ? "errors: those of the answers at the end of the march"
                               : "errors: not measured";
    case ErrorMeter::Truth::kSolution:
      return "errors: against the known solution x";
    case ErrorMeter::Truth::kSlack:
      return "errors: against the known w = M x + q, as x need not be unique";
    case ErrorMeter::Truth::kConverged:
    case ErrorMeter::Truth::kBestFound:
      return fmt::format("errors: against the best x found here, by pgs-sm to 1e-12{}",
                         BestRemark(problem.best_residual));
  }
  return "";
}

std::string Heading(const ProblemResult& problem) {
  std::string text = fmt::format("{}: {} unknowns, {} of them free, {} entries", problem.name,
                                 problem.size, problem.free_rows, problem.nonzeros);
  if (problem.steps > 1) text += fmt::format(", {} problems one after the other", problem.steps);
  for (size_t i = 0; i < problem.parameters.size(); ++i) {
    const auto& [name, value] = problem.parameters[i];
    text += fmt::format("{}{} = {:g}", i == 0 ? "\n" : ", ", name, value);
  }
  if (!problem.source.empty()) text += fmt::format("\nsource: {}", problem.source);
  return fmt::format("{}\n{}\n", text, TruthText(problem));
}

/// Names of the first few, and how many there are.
std::string Some(const std::vector<std::string>& names) {
  const size_t shown = std::min(names.size(), kNamedProblems);
  std::string text = fmt::format("{}", fmt::join(names.begin(), names.begin() + shown, ", "));
  if (names.size() > shown) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

/// Why a solver did not solve a problem; empty if it did.
std::string ReasonOf(const SolveResult& result, const LcpSolverResult& solver) {
  const std::string reason = solver.failure.value_or("");
  // Numbers would make every reason another one.
  return IsSingle(result) ? reason : reason.substr(0, reason.find(" at residual"));
}

std::string MatrixReadingHelp(const SolveResult& result) {
  std::string help = fmt::format(
      "time: {} of the solver alone, from the problem in memory to the answer{}.\n"
      "residual: of the natural map, rows scaled by the diagonal, relative to q. Solved means at "
      "most\n"
      "{:g}, and every answer met. nz(L): entries of the largest factor.\n",
      result.clock == SolverClock::kThreadCpu ? "CPU time" : "wall-clock time",
      result.repeat > 1 ? fmt::format(", median of {}", result.repeat) : "",
      result.options.tolerance);
  if (AnyErrors(result, ProblemKind::kMatrix)) {
    help +=
        "error: of x: |x - x*| / |x*|; of w: |w - w*| / |q|; of best: as x, x* being the best "
        "found here.\n"
        "to 0.1 and so on: until the first iterate with that error. It is from another run, which "
        "was\n"
        "watched; the time of watching is left out.\n";
  }
  if (result.start == StartRule::kNested) {
    help +=
        "of it coarse: time on coarser grids for the start, which counts; sweeps and "
        "factorisations\n"
        "are those of the finest grid.\n";
  }
  if (result.any_march()) {
    help +=
        "Problems one after the other: time and work are sums, residual is the largest of all.\n";
  }
  return help;
}

}  // namespace

TextTable WorkTable(const SolveResult& result) {
  const bool nested = result.start == StartRule::kNested;
  const bool errors = AnyErrors(result, ProblemKind::kMatrix);
  TextTable table = NamedTable(result, ProblemKind::kMatrix);
  table.columns.push_back({"time", "ms"});
  if (nested) table.columns.push_back({"of it coarse", "ms"});
  for (const char* name : {"sweeps", "factorised", "nz(L)"}) table.columns.push_back({name, ""});
  table.columns.push_back({"residual", "relative"});
  if (errors) {
    table.columns.push_back({"error", "2-norm"});
    table.columns.push_back({"error", "energy"});
    table.columns.push_back({"of", ""});
  }
  table.columns.push_back({"end", ""});
  AddRows(result, ProblemKind::kMatrix, &table,
          [=](const ProblemResult& problem, const LcpSolverResult& solver, auto* row) {
            row->push_back(FormatTime(solver.time));
            if (nested) row->push_back(FormatTime(solver.nested_time));
            row->push_back(FormatCount(solver.sweeps));
            row->push_back(FormatCount(solver.factorisations));
            row->push_back(FormatCount(solver.factor_nonzeros));
            row->push_back(FormatNumber(solver.residual.relative));
            if (errors) AddErrorCells(problem, solver, row);
            row->push_back(Ended(solver));
          });
  return table;
}

TextTable ErrorTable(const SolveResult& result) {
  TextTable table = NamedTable(result, ProblemKind::kMatrix);
  for (const double level : result.errors) {
    table.columns.push_back({fmt::format("to {:g}", level), "ms"});
    table.columns.push_back({"sweeps", "+ factorised"});
  }
  for (const ProblemResult& problem : result.problems) {
    if (problem.rows || problem.truth == ErrorMeter::Truth::kNone) continue;
    for (const LcpSolverResult& solver : problem.solvers) {
      std::vector<std::string> row = NameCells(result, problem, solver);
      for (const LevelReached& level : solver.levels) {
        row.push_back(level.first ? FormatTime(level.first->time) : "-");
        row.push_back(level.first ? EffortText(*level.first) : "-");
      }
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

TextTable AnswerTable(const SolveResult& result) {
  TextTable table = NamedTable(result, ProblemKind::kMatrix);
  table.columns.push_back({"answer", ""});
  table.names = table.columns.size();
  for (const char* name : {"value", "expected", "difference", "allowed", ""}) {
    table.columns.push_back({name, ""});
  }
  for (const ProblemResult& problem : result.problems) {
    for (const LcpSolverResult& solver : problem.solvers) {
      for (const AnswerResult& answer : solver.answers) {
        std::vector<std::string> row = NameCells(result, problem, solver);
        row.push_back(answer.name);
        row.push_back(fmt::format("{:.8g}", answer.value));
        row.push_back(fmt::format("{:.8g}", answer.expected));
        row.push_back(fmt::format("{:.1e}", answer.value - answer.expected));
        row.push_back(fmt::format("{:.1e}", answer.tolerance));
        row.push_back(answer.ok() ? "ok" : "MISSED");
        table.rows.push_back(std::move(row));
      }
    }
  }
  return table;
}

TextTable PhaseTable(const SolveResult& result) {
  if (!result.options.phases) return {};
  TextTable table = NamedTable(result, ProblemKind::kMatrix);
  for (const auto& [name, phase] : kPhases) table.columns.push_back({name, "ms"});
  AddRows(result, ProblemKind::kMatrix, &table,
          [](const ProblemResult&, const LcpSolverResult& solver, auto* row) {
            for (const auto& [name, phase] : kPhases) {
              row->push_back(FormatTime(Milliseconds(solver.phases.*phase)));
            }
          });
  return table;
}

namespace {

/// How far a solver got with all problems.
struct Score {
  size_t matrices = 0, solved = 0;
  size_t frames = 0, converged = 0;
  std::map<std::string, size_t> stops;  ///< Of frames that did not converge, and are no failures.
  /// Of failures, and the problems that failed so.
  std::map<std::string, std::vector<std::string>> reasons;
  bool single = true;

  std::string ToText() const {
    std::string text;
    if (matrices > 0) text = fmt::format("{} of {} solved", solved, matrices);
    if (frames > 0) {
      text += fmt::format("{}{} of {} converged", text.empty() ? "" : "; of frames ", converged,
                          frames);
      for (const auto& [stop, count] : stops) text += fmt::format(", {} {}", count, stop);
    }
    for (const auto& [reason, names] : reasons) {
      text += single ? fmt::format("; {}", reason)
                     : fmt::format("; {} {} ({})", names.size(), reason, Some(names));
    }
    return text;
  }
};

void AddTo(Score* score, const SolveResult& result, const ProblemResult& problem,
           const LcpSolverResult& solver) {
  score->single = IsSingle(result);
  ++(problem.rows ? score->frames : score->matrices);
  if (solver.failure) {
    score->reasons[ReasonOf(result, solver)].push_back(problem.name);
  } else if (!problem.rows) {
    ++score->solved;
  } else if (solver.stop == "converged" || result.row_options.tolerance > 0) {
    ++score->converged;  // to the tolerance that was asked for, if one was: else it had failed
  } else {
    ++score->stops[solver.stop];
  }
}

}  // namespace

std::string Heading(const SolveResult& result) {
  if (IsSingle(result)) {
    const ProblemResult& problem = result.problems.front();
    return problem.rows ? FrameHeading(problem) : Heading(problem);
  }
  std::string text = fmt::format("{} problems, {} solver{}\n", result.problems.size(),
                                 result.solvers.size(), result.solvers.size() == 1 ? "" : "s");
  for (const ProblemResult& problem : result.problems) {
    if (problem.rows) text += FrameHeading(problem);
  }
  return text;
}

std::string SolvedSummary(const SolveResult& result) {
  std::string text;
  for (const std::string& label : result.solvers) {
    Score score;
    for (const ProblemResult& problem : result.problems) {
      for (const LcpSolverResult& solver : problem.solvers) {
        if (solver.label == label) AddTo(&score, result, problem, solver);
      }
    }
    text += fmt::format("{}: {}\n", label, score.ToText());
  }
  if (!result.skipped.empty()) {
    std::vector<std::string> names;
    for (const SkippedFolder& folder : result.skipped) names.push_back(folder.name);
    text += fmt::format("{} skipped, {} ({})\n", names.size(), result.skipped.front().reason,
                        Some(names));
  }
  if (!result.unread.empty()) {
    std::vector<std::string> paths;
    for (const UnreadFile& file : result.unread) paths.push_back(file.path);
    text += fmt::format("{} left out, not usable ({})\n", paths.size(), Some(paths));
  }
  return text;
}

std::string ReadingHelp(const SolveResult& result) {
  std::string help;
  if (result.any_matrix()) help += MatrixReadingHelp(result);
  if (result.any_frame()) help += FrameReadingHelp(result);
  return help + fmt::format("Machine: {}, {}.\n", result.machine.cpu, result.noise.verdict);
}

namespace {

std::vector<TextTable> TablesWithRows(const SolveResult& result) {
  std::vector<TextTable> tables = {WorkTable(result),       ErrorTable(result),
                                   AnswerTable(result),     PhaseTable(result),
                                   FrameWorkTable(result),  FrameLevelTable(result),
                                   FrameErrorTable(result), FrameResidualTable(result)};
  std::erase_if(tables, [](const TextTable& table) { return table.rows.empty(); });
  return tables;
}

}  // namespace

std::string ToText(const SolveResult& result) {
  std::string text = Heading(result);
  for (const TextTable& table : TablesWithRows(result)) text += fmt::format("\n{}", table.ToText());
  return fmt::format("{}\n{}\n", text, SolvedSummary(result));
}

std::string ToMarkdown(const SolveResult& result) {
  std::string text = Heading(result);
  for (const TextTable& table : TablesWithRows(result))
    text += fmt::format("\n{}", table.ToMarkdown());
  return text + "\n" + SolvedSummary(result) + "\n" + ReadingHelp(result) +
         fmt::format("\nCommand: `{}`\n", result.command);
}

}  // namespace cairn::cli
