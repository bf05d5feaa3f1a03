// SPDX-License-Identifier: MIT
#include "solve/output/solve_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <system_error>
#include <utility>

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

void RemoveProblem(const fs::path& place) {
  std::error_code ignored;  // what stays cannot be written either, which is said then
  for (const char* name : kFilesOfProblem) fs::remove(place / name, ignored);
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
  std::map<fs::path, std::unique_ptr<problems::Source>> sources;
  for (const ProblemChoice& choice : choices) {
    auto source = choice.make();
    const std::string name = source->current().name;
    const fs::path place = fs::path(folder) / name;
    if (if_there == IfThere::kRefuse && HoldsProblem(place)) {
      throw Failure(kBadInput, fmt::format("'{}' holds a problem already: --force writes over it",
                                           place.string()));
    }
    if (!sources.emplace(place, std::move(source)).second) {
      throw Failure(kUsage, fmt::format("--export: two problems have the name '{}'", name));
    }
  }
  for (const auto& [place, source] : sources) {
    RemoveProblem(place);
    try {
      problems::WriteProblemFolder(place, source->current());
    } catch (const problems::FileError& error) {
      throw Failure(kBadInput, error.what());
    }
  }
}

}  // namespace cairn::cli
