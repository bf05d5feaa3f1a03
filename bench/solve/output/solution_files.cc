// SPDX-License-Identifier: MIT
#include "solve/output/solve_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <system_error>

#include "problems/problem_folder.h"
#include "support/failure.h"
#include "support/output_file.h"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

/// Everything a problem may consist of: what is left of another problem would be taken for a part
/// of this one.
constexpr const char* kFilesOfProblem[] = {"meta.json", "matrix.mtx",   "q.mtx", "lower.mtx",
                                           "upper.mtx", "solution.mtx", "w.mtx"};

bool HoldsProblem(const fs::path& place) {
  return std::ranges::any_of(kFilesOfProblem,
                             [&](const char* name) { return fs::exists(place / name); });
}

/// Writes a problem beside the one that is there, then puts it into its place: what was there is
/// gone only when all of the new one is on the disk.
void ReplaceProblem(const fs::path& place, const problems::Problem& problem) {
  const fs::path beside = place.string() + ".new";
  problems::WriteProblemFolder(beside, problem);
  std::error_code error;
  for (const char* name : kFilesOfProblem) {
    if (fs::exists(beside / name)) {
      fs::rename(beside / name, place / name, error);
    } else {
      fs::remove(place / name, error);
    }
    if (error) {
      throw Failure(kBadInput,
                    fmt::format("'{}' cannot be written: {}; all of the problem is in '{}'",
                                (place / name).string(), error.message(), beside.string()));
    }
  }
  fs::remove(beside, error);
}

}  // namespace

void WriteSolutions(const std::string& folder, const SolveResult& result) {
  for (const ProblemResult& problem : result.problems) {
    for (const LcpSolverResult& solver : problem.solvers) {
      const fs::path place = fs::path(folder) / problem.name / solver.label;
      CheckFolder(place);
      try {
        problems::WriteVector(place / "x.mtx", solver.x);
        problems::WriteVector(place / "w.mtx", solver.w);
      } catch (const problems::FileError& error) {
        throw Failure(kBadInput, error.what());
      }
    }
  }
}

void WriteProblems(const std::string& folder, std::span<const ProblemChoice> choices,
                   IfThere if_there) {
  // all are looked at before one is written; each is made twice, so that memory holds one at a time
  std::set<std::string> names;
  for (const ProblemChoice& choice : choices) {
    const std::string name = choice.make()->current().name;
    const fs::path place = fs::path(folder) / name;
    if (if_there == IfThere::kRefuse && HoldsProblem(place)) {
      throw Failure(kBadInput, fmt::format("'{}' holds a problem already: --force writes over it",
                                           place.string()));
    }
    if (!names.insert(name).second) {
      throw Failure(kUsage, fmt::format("--export: two problems have the name '{}'", name));
    }
  }
  for (const ProblemChoice& choice : choices) {
    const std::unique_ptr<problems::Source> source = choice.make();
    const fs::path place = fs::path(folder) / source->current().name;
    try {
      HoldsProblem(place) ? ReplaceProblem(place, source->current())
                          : problems::WriteProblemFolder(place, source->current());
    } catch (const problems::FileError& error) {
      throw Failure(kBadInput, error.what());
    }
  }
}

}  // namespace cairn::cli
