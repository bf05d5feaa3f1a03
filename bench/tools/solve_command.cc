// SPDX-License-Identifier: MIT
#include "tools/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "CLI/CLI.hpp"
#include "solve/output/solve_output.h"
#include "solve/solve.h"
#include "solve/solver_choice.h"
#include "support/command_line.h"
#include "support/duration.h"
#include "support/failure.h"
#include "support/machine/setup.h"
#include "support/names.h"
#include "support/output_file.h"
#include "tools/solver_names.h"

namespace cairn::cli {
namespace {

/// What was typed behind the options of `cairn solve`.
struct SolveWords {
  ProblemWords problems;
  std::string solvers, errors, start = "warm", order = "automatic";
  std::string tolerance, max_sweeps, budget, threads = "1", repeat = "1";
  std::string k_gs, k_sm, tol, omega;
  std::string json, csv, markdown, history, plot, solution, exported;
  bool phases = false, force = false;
  OutputWords output;
};

constexpr const char* kSolveNotes =
    R"(A problem is the name of a generator (cairn list problems), a folder with meta.json, matrix.mtx
and q.mtx (Matrix Market text), or a folder of such folders, which means all of them. It may also be
a recorded frame of a game, or a folder of these: *.cairn, from 'cairn record' or CAIRN_RECORD.

Time is CPU time of the solver alone, wall-clock time with --threads above 1. Each problem is solved
twice: watched, for the error over time (the time of watching is left out), and then with nobody
looking on, which is what counts as its time. --repeat N does the latter N times.

Errors are those of x against the known solution; of w = M x + q where x is not known to be unique;
and of x against the best one found here (pgs-sm to 1e-12) where nothing is known. A march,
such as an option that is priced from expiry back to today, has answers instead. --errors none
measures no errors: for large problems without a known solution.

On a recorded frame, each solver goes from the recorded start as far as --budget (default 20ms) or
--max-sweeps lets it, and as far as ever smaller shares of that for the curve. Errors are of
velocities against a converged reference, and natural residuals, both in m/s.

Exit codes: 0 fine, 1 a solver refused, missed the tolerance or an answer, 2 usage, 3 a file
cannot be used. What cannot be read in a folder of several is left out, and the others are solved:
that is 3, too.)";

constexpr std::pair<StartRule, const char*> kStarts[] = {
    {StartRule::kZero, "zero"}, {StartRule::kWarm, "warm"}, {StartRule::kNested, "nested"}};
constexpr std::pair<lcp::SweepOrder, const char*> kOrders[] = {
    {lcp::SweepOrder::kAutomatic, "automatic"},
    {lcp::SweepOrder::kForward, "forward"},
    {lcp::SweepOrder::kReverse, "reverse"},
    {lcp::SweepOrder::kSymmetric, "symmetric"},
    {lcp::SweepOrder::kColoured, "coloured"}};

/// The value that goes by a name in a list of pairs.
template <class Names>
auto ParseName(std::string_view kind, std::string_view word, const Names& pairs) {
  std::vector<std::string> names;
  for (const auto& [value, name] : pairs) names.emplace_back(name);
  const std::string help = fmt::format("write one of {}", fmt::join(names, ", "));
  return pairs[FindName(kind, word, names, help)].first;
}

template <class Value, class Names>
const char* NameOf(Value value, const Names& pairs) {
  return std::find_if(std::begin(pairs), std::end(pairs),
                      [value](const auto& pair) { return pair.first == value; })
      ->second;
}

constexpr const char* kErrorsOfMatrices = "1e-1,1e-2,1e-6";
constexpr const char* kErrorsOfFrames = "1e-1,1e-2,1e-3";
/// For a frame, where neither budget nor sweeps are given.
constexpr auto kBudgetOfFrames = std::chrono::milliseconds(20);

/// Falling, each once; "none" for none.
std::vector<double> ParseErrors(const std::string& text) {
  std::vector<double> errors;
  if (text == "none") return errors;
  for (const std::string& word : Split(text, ',')) {
    errors.push_back(
        ParseNumber("--errors", word, 1e-16, 1e3, "errors with commas between, or none"));
  }
  if (errors.empty()) throw Failure(kUsage, "--errors names no error; write 1e-2,1e-6, or none");
  std::sort(errors.begin(), errors.end(), std::greater<>());
  errors.erase(std::unique(errors.begin(), errors.end()), errors.end());
  return errors;
}

/// Solvers of all makes are compared here, and work is counted by Cairn's alone.
std::chrono::nanoseconds ParseTimeBudget(const std::string& text) {
  if (text.ends_with("units")) {
    throw Failure(kUsage, fmt::format("--budget '{}': cairn solve takes a time, such as 2ms, as "
                                      "not all its solvers count work; for the same results each "
                                      "time give --max-sweeps, such as --max-sweeps 100",
                                      text));
  }
  return ParseDuration("--budget", text);
}

LcpOptions CheckSolver(const SolveWords& words) {
  constexpr int kMost = std::numeric_limits<int>::max();
  LcpOptions options;
  if (!words.tolerance.empty()) {
    options.tolerance = ParseNumber("--tolerance", words.tolerance, 1e-16, 1,
                                    "natural residual at which a solver stops");
  }
  if (!words.max_sweeps.empty()) {
    options.max_sweeps = ParseInt("--max-sweeps", words.max_sweeps, 0, kMost, "sweeps at most");
  }
  if (!words.budget.empty()) options.budget = ParseTimeBudget(words.budget);
  options.order = ParseName("order", words.order, kOrders);
  options.threads = ParseInt("--threads", words.threads, 1, 1024, "threads of a solver");
  if (!words.k_gs.empty()) {
    options.k_gs =
        ParseInt("--k-gs", words.k_gs, 1, 1'000'000, "sweeps before and after each subspace step");
  }
  if (!words.k_sm.empty()) {
    options.k_sm =
        ParseInt("--k-sm", words.k_sm, 0, 1000, "factorisations in a subspace step at most");
  }
  if (!words.tol.empty()) {
    options.active_tolerance =
        ParseNumber("--tol", words.tol, 0, std::numeric_limits<double>::max(),
                    "a row this near to a bound is at it");
  }
  if (!words.omega.empty()) {
    options.omega = ParseNumber("--omega", words.omega, 0.01, 1.99, "over-relaxation of psor");
  }
  return options;
}

/// The same for recorded frames.
LcpOptions CheckRowSolver(const SolveWords& words) {
  LcpOptions options = CheckSolver(words);
  if (words.tolerance.empty()) options.tolerance = 0;
  if (!options.max_sweeps && !options.budget) options.budget = kBudgetOfFrames;
  if (options.max_sweeps == 0) {
    throw Failure(kUsage, "--max-sweeps 0: solvers of recorded frames make one sweep at least");
  }
  return options;
}

void CheckFrames(const SolveOptions& options, const SolveWords& words) {
  if (options.start == StartRule::kNested) {
    throw Failure(kUsage, "--start nested: recorded frames have no coarser grid to begin with");
  }
  if (options.problems.empty() && !words.exported.empty()) {
    throw Failure(kUsage, "--export is for problems in matrix form: recordings are files already");
  }
}

void RefuseWithoutGrids(const std::vector<ProblemChoice>& choices) {
  for (const ProblemChoice& choice : choices) {
    const auto source = choice.make();
    const problems::Problem& problem = source->current();
    if (problem.coarser && problem.prolong) continue;
    throw Failure(
        kUsage, fmt::format("--start nested: {} has no coarser grid to begin with", problem.name));
  }
}

SolveOptions Check(const SolveWords& words) {
  SolveOptions options;
  ProblemChoices choices = ParseProblems(words.problems);
  options.problems = std::move(choices.problems);
  options.frames = std::move(choices.frames);
  options.skipped = std::move(choices.skipped);
  options.unread = std::move(choices.unread);
  const ProblemKinds kinds{.matrices = !options.problems.empty(),
                           .frames = !options.frames.empty()};
  if (!kinds.matrices && !kinds.frames) {
    if (!options.unread.empty()) throw Failure(kBadInput, options.unread.front().reason);
    throw Failure(kBadInput, fmt::format("nothing to solve: all {} problems are of kind friction",
                                         options.skipped.size()));
  }
  SolverChoices solvers = ChooseSolvers(OwnSolverNames(SolverUser::kSolve, words.solvers), kinds);
  options.solvers = std::move(solvers.of_matrices);
  options.row_solvers = std::move(solvers.of_frames);
  options.solver_names = std::move(solvers.names);
  options.solver = CheckSolver(words);
  options.solver.phases = words.phases;
  options.errors = ParseErrors(!words.errors.empty() ? words.errors
                               : kinds.matrices      ? kErrorsOfMatrices
                                                     : kErrorsOfFrames);
  options.start = ParseName("start", words.start, kStarts);
  options.repeat = ParseInt("--repeat", words.repeat, 1, 10'000, "solves whose median time counts");
  options.progress = ParseProgress(words.output);
  if (options.errors.empty() && !words.history.empty()) {
    throw Failure(kUsage, "--history needs errors: leave --errors none away");
  }
  if (options.errors.empty() && !words.plot.empty()) {
    throw Failure(kUsage, "--plot needs errors: leave --errors none away");
  }
  if (!words.plot.empty() && !words.plot.ends_with(".svg")) {
    throw Failure(kUsage, fmt::format("--plot '{}': the picture is SVG; write a name that ends in "
                                      ".svg, such as error.svg",
                                      words.plot));
  }
  if (kinds.frames) {
    options.row_solver = CheckRowSolver(words);
    CheckFrames(options, words);
  }
  if (options.start == StartRule::kNested) RefuseWithoutGrids(options.problems);
  return options;
}

int DoSolve(const SolveWords& words, const std::string& command) {
  const std::vector<ResultFile<SolveResult>> files = {{words.json, &ToJson},
                                                      {words.csv, &ToCsv},
                                                      {words.markdown, &ToMarkdown},
                                                      {words.history, &HistoryToCsv},
                                                      {words.plot, &ToSvg}};
  const SolveOptions options = Check(words);
  CheckWritable(files);
  if (!words.solution.empty()) CheckFolder(words.solution);
  if (!words.exported.empty()) {
    CheckFolder(words.exported);
    WriteProblems(words.exported, options.problems,
                  words.force ? IfThere::kOverwrite : IfThere::kRefuse);
  }
  WarnOfTarget();
  for (const UnreadFile& file : options.unread) {
    fmt::print(stderr, "cairn: left out: {}\n", file.reason);
  }
  const SolveResult result = Solve(options, command);
  fmt::print("{}", ToText(result));
  if (!words.output.quiet) fmt::print("{}", ReadingHelp(result));
  WriteFiles(files, result);
  if (!words.solution.empty()) WriteSolutions(words.solution, result);
  if (result.any_failed()) return kCheckFailed;
  return result.unread.empty() ? kFine : kBadInput;
}

void AddSolverOptions(CLI::App* solve, SolveWords* words) {
  solve
      ->add_option("--solver", words->solvers,
                   "Solvers, with commas between them; default pgs,pgs-sm,ipm, of recorded frames "
                   "pgs,pgs-sm,bullet-si,bullet-nncg")
      ->type_name("A,B,...")
      ->take_last();
  const auto add = TextAdder(solve);
  add("--tolerance", &words->tolerance,
      "Natural residual at which a solver stops: relative, default 1e-9; of recorded frames in "
      "m/s, default none",
      "R");
  add("--max-sweeps", &words->max_sweeps, "Sweeps at most; default 50000, pgs-sm: none", "N");
  add("--budget", &words->budget,
      "Time for a problem, such as 2ms, 5s; default: none, of recorded frames 20ms; --max-sweeps "
      "gives the same results each time",
      "TIME");
  add("--start", &words->start,
      "zero, warm (what the problem brings; default) or nested (coarser grids first)", "HOW");
  add("--order", &words->order,
      "Order of the rows in a sweep: automatic, forward, reverse, symmetric, coloured", "ORDER");
  add("--threads", &words->threads, "Threads of a solver; default 1", "N");
  add("--k-gs", &words->k_gs, "Sweeps before and after each subspace step; default 5", "N");
  add("--k-sm", &words->k_sm, "Factorisations in a subspace step at most; default 2", "N");
  add("--tol", &words->tol,
      "The paper's tol: a row no further from a bound than this is at it; default 0", "X");
  add("--omega", &words->omega, "Over-relaxation of psor; default 1.5", "W");
}

}  // namespace

const char* Name(StartRule start) { return NameOf(start, kStarts); }
const char* Name(lcp::SweepOrder order) { return NameOf(order, kOrders); }

Command AddSolveCommand(CLI::App* app) {
  const auto words = std::make_shared<SolveWords>();
  CLI::App* const solve = app->add_subcommand(
      "solve",
      "Solve problems in matrix form, and recorded frames, and measure time, work and error");
  solve->footer(kSolveNotes);
  solve->add_option("problem", words->problems.names, "Generators, folders of problems, recordings")
      ->required()
      ->type_name("FILE|GENERATOR");
  const auto add = TextAdder(solve);
  add("--size", &words->problems.size, "Size of generated problems; see cairn list problems", "N");
  solve->add_option("--set", words->problems.settings, "Sets a parameter of generated problems")
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  AddSolverOptions(solve, words.get());
  add("--errors", &words->errors,
      "Errors until which time is taken; default 1e-1,1e-2,1e-6, of recorded frames "
      "1e-1,1e-2,1e-3; none to measure none",
      "A,B,...");
  add("--repeat", &words->repeat, "Solves whose median time counts; default 1", "N");
  solve->add_flag("--phases", words->phases,
                  "Show where the time of Cairn's solvers goes, wall clock");
  add("--json", &words->json, "Write everything that was measured", "FILE");
  add("--csv", &words->csv, "Write a line for each problem and solver", "FILE");
  add("--markdown", &words->markdown, "Write the tables as Markdown", "FILE");
  add("--history", &words->history, "Write error over time, a line for each iterate (CSV)", "FILE");
  add("--plot", &words->plot, "Draw error over time (SVG)", "FILE");
  add("--solution", &words->solution, "Write x and w of each solver, DIR/PROBLEM/SOLVER/x.mtx",
      "DIR");
  add("--export", &words->exported, "Write the problems as folders, DIR/PROBLEM", "DIR");
  solve->add_flag("--force", words->force, "Write over problems that --export finds there already");
  AddOutputWords(solve, &words->output);
  return {solve, [words](const std::string& typed) { return DoSolve(*words, typed); }};
}

}  // namespace cairn::cli
