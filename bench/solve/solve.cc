// SPDX-License-Identifier: MIT
#include "solve/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "solve/pair_run.h"
#include "solve/row_run.h"

namespace cairn::cli {
namespace {

using problems::Problem;

ProblemResult Describe(const ProblemChoice& choice, const problems::Source& source) {
  const Problem& problem = source.current();
  const BoxedLcp& lcp = problem.lcp;
  ProblemResult result;
  result.name = problem.name;
  result.source = problem.source;
  result.generator_size = choice.size;
  result.parameters = choice.parameters;
  result.size = lcp.size();
  result.nonzeros = lcp.M.nonZeros();
  result.free_rows = (lcp.lo.array() == -INFINITY && lcp.hi.array() == INFINITY).count();
  result.steps = source.steps();
  return result;
}

class Run {
 public:
  Run(const SolveOptions& options, SolverClock clock)
      : options_(options), clock_(clock), progress_(options.progress) {}

  ProblemResult SolveWithAll(const ProblemChoice& choice) {
    const auto source = choice.make();
    const Problem& problem = source->current();
    ProblemResult result = Describe(choice, *source);
    Enter(result.name);
    ErrorMeter meter;
    if (!options_.errors.empty() && result.steps == 1) {
      progress_.Show(fmt::format("{}: reference", where_));
      meter = ErrorMeter(problem);
    }
    result.truth = meter.truth();
    result.truth_name = meter.name();
    result.best_residual = meter.best_residual();
    for (const LcpSolverEntry* entry : options_.solvers) {
      result.solvers.push_back(SolveWith(*entry, choice, source.get(), meter));
    }
    return result;
  }

  ProblemResult SolveFrame(const RowProblem& recorded) {
    Enter(recorded.name);
    std::optional<RowProblem> from_zero;
    if (options_.start == StartRule::kZero) from_zero = FromZero(recorded);
    const RowProblem& problem = from_zero ? *from_zero : recorded;
    progress_.Show(fmt::format("{}: reference", where_));
    using Reference = RowErrorMeter::Reference;
    const RowErrorMeter meter(problem,
                              options_.errors.empty() ? Reference::kNone : Reference::kFind);
    ProblemResult result = DescribeFrame(problem, meter);
    for (const RowSolverEntry* entry : options_.row_solvers) {
      RowRun run(options_, *entry, clock_, [this](const std::string& what) {
        progress_.Show(fmt::format("{}: {}", where_, what));
      });
      result.solvers.push_back(run.Solve(problem, meter));
    }
    return result;
  }

 private:
  void Enter(const std::string& name) {
    const size_t all = options_.problems.size() + options_.frames.size();
    where_ = fmt::format("{} ({} of {})", name, ++number_, all);
  }

  LcpSolverResult SolveWith(const LcpSolverEntry& entry, const ProblemChoice& choice,
                            problems::Source* first, const ErrorMeter& meter) {
    PairRun run(options_, entry, clock_);
    const Problem& problem = first->current();
    if (meter.truth() != ErrorMeter::Truth::kNone) {
      run.Watch(problem, meter, [&](const lcp::Iterate& iterate) {
        progress_.Show(fmt::format("{}: {}, {} sweeps, {} factorisations", where_, entry.name,
                                   iterate.sweeps, iterate.factorisations));
      });
    }
    for (int i = 0; i < options_.repeat; ++i) {
      // A march is over once it was solved; a single problem stays.
      const auto march = first->steps() > 1 ? choice.make() : nullptr;
      run.Solve(march ? march.get() : first, [&](int step) {
        progress_.Show(fmt::format("{}: {}, timing {} of {}, problem {} of {}", where_, entry.name,
                                   i + 1, options_.repeat, step + 1, first->steps()));
      });
    }
    return run.Finish(problem.lcp, meter);
  }

  const SolveOptions& options_;
  SolverClock clock_;
  Progress progress_;
  size_t number_ = 0;
  std::string where_;
};

}  // namespace

SolveResult Solve(const SolveOptions& options, const std::string& command) {
  SolveResult result;
  static_cast<RunContext&>(result) = DescribeContext(command);
  result.options = options.solver;
  result.start = options.start;
  result.repeat = options.repeat;
  result.clock = options.solver.threads > 1 ? SolverClock::kWall : SolverClock::kThreadCpu;
  result.errors = options.errors;
  result.skipped = options.skipped;
  result.unread = options.unread;
  result.row_options = options.row_solver;
  result.solvers = options.solver_names;

  Run run(options, result.clock);
  std::set<std::string> names;
  const auto add = [&](ProblemResult problem) {
    const std::string name = problem.name;
    // Names become folders of --solution, and rows that must be told apart.
    for (int copy = 2; !names.insert(problem.name).second; ++copy) {
      problem.name = fmt::format("{}-{}", name, copy);
    }
    result.problems.push_back(std::move(problem));
  };
  for (const ProblemChoice& choice : options.problems) add(run.SolveWithAll(choice));
  for (const auto& frame : options.frames) add(run.SolveFrame(*frame));
  return result;
}

bool AnswerResult::ok() const { return std::abs(value - expected) <= tolerance; }

bool SolveResult::any_failed() const {
  return std::any_of(problems.begin(), problems.end(), [](const ProblemResult& problem) {
    return std::any_of(problem.solvers.begin(), problem.solvers.end(),
                       [](const LcpSolverResult& solver) { return solver.failure.has_value(); });
  });
}

bool SolveResult::any_frame() const {
  return std::any_of(problems.begin(), problems.end(),
                     [](const ProblemResult& problem) { return problem.rows.has_value(); });
}

bool SolveResult::any_matrix() const {
  return std::any_of(problems.begin(), problems.end(),
                     [](const ProblemResult& problem) { return !problem.rows.has_value(); });
}

bool SolveResult::any_march() const {
  return std::any_of(problems.begin(), problems.end(),
                     [](const ProblemResult& problem) { return problem.steps > 1; });
}

}  // namespace cairn::cli
