// SPDX-License-Identifier: MIT
#include "solve/output/solve_output.h"

#include <filesystem>

#include "problems/problem_folder.h"
#include "support/failure.h"
#include "support/output_file.h"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

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
