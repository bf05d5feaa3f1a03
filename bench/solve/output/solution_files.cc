// SPDX-License-Identifier: MIT
#include "solve/output/solution_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "problems/problem_folder.h"
#include "support/failure.h"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

void Make(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw Failure(kBadInput,
                  fmt::format("cannot make folder '{}': {}", folder.string(), error.message()));
  }
}

}  // namespace

void CheckFolder(const std::string& folder) {
  Make(folder);
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw Failure(kBadInput, fmt::format("cannot write into folder '{}'", folder));
  }
}

void WriteSolutions(const std::string& folder, const SolveResult& result) {
  for (const ProblemResult& problem : result.problems) {
    for (const LcpSolverResult& solver : problem.solvers) {
      const fs::path place = fs::path(folder) / problem.name / solver.label;
      Make(place);
      try {
        problems::WriteVector(place / "x.mtx", solver.x);
        problems::WriteVector(place / "w.mtx", solver.w);
      } catch (const problems::FileError& error) {
        throw Failure(kBadInput, error.what());
      }
    }
  }
}

void WriteProblems(const std::string& folder, std::span<const ProblemChoice> choices) {
  for (const ProblemChoice& choice : choices) {
    const auto source = choice.make();
    const problems::Problem& problem = source->current();
    try {
      problems::WriteProblemFolder(fs::path(folder) / problem.name, problem);
    } catch (const problems::FileError& error) {
      throw Failure(kBadInput, error.what());
    }
  }
}

}  // namespace cairn::cli
