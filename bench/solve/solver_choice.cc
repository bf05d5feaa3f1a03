// SPDX-License-Identifier: MIT
#include "solve/solver_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "support/failure.h"
#include "support/names.h"

namespace cairn::cli {
namespace {

constexpr std::string_view kOfMatrices = "pgs,pgs-sm,ipm";
constexpr std::string_view kOfFrames = "pgs,pgs-sm,bullet-si,bullet-nncg";

std::vector<std::string> AllNames() {
  std::vector<std::string> names;
  for (const LcpSolverEntry& entry : LcpSolvers()) names.push_back(entry.name);
  for (const RowSolverEntry& entry : RowSolvers()) {
    if (std::find(names.begin(), names.end(), entry.name) == names.end()) {
      names.push_back(entry.name);
    }
  }
  return names;
}

template <class Entry>
const Entry* Find(std::span<const Entry> entries, const std::string& name) {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&name](const Entry& entry) { return entry.name == name; });
  return found == entries.end() ? nullptr : &*found;
}

void Add(const std::string& name, const ProblemKinds& kinds, SolverChoices* choices) {
  if (std::find(choices->names.begin(), choices->names.end(), name) != choices->names.end()) {
    throw Failure(kUsage, fmt::format("--solver names {} twice", name));
  }
  const LcpSolverEntry* const of_matrices = Find(LcpSolvers(), name);
  const RowSolverEntry* const of_frames = Find(RowSolvers(), name);
  if (of_matrices != nullptr && !of_matrices->make) {
    throw Failure(kUsage, fmt::format("--solver {}: {}", name, of_matrices->description));
  }
  const bool some =
      (of_matrices != nullptr && kinds.matrices) || (of_frames != nullptr && kinds.frames);
  if (!some) {
    throw Failure(kUsage,
                  fmt::format("--solver {} solves {}, and there is none among the problems", name,
                              of_frames == nullptr ? "problems in matrix form only"
                                                   : "recorded frames only"));
  }
  choices->names.push_back(name);
  if (of_matrices != nullptr && kinds.matrices) choices->of_matrices.push_back(of_matrices);
  if (of_frames != nullptr && kinds.frames) choices->of_frames.push_back(of_frames);
}

/// The usual solvers, those of frames behind those of matrices.
std::vector<std::string> UsualNames(const ProblemKinds& kinds) {
  std::vector<std::string> names;
  if (kinds.matrices) names = Split(kOfMatrices, ',');
  if (!kinds.frames) return names;
  for (const std::string& name : Split(kOfFrames, ',')) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

}  // namespace

SolverChoices ChooseSolvers(std::string_view list, const ProblemKinds& kinds) {
  SolverChoices choices;
  const std::vector<std::string> all = AllNames();
  const std::vector<std::string> words = list.empty() ? UsualNames(kinds) : Split(list, ',');
  for (const std::string& word : words) {
    Add(all[FindName("solver", word, all, "'cairn list solvers' shows all")], kinds, &choices);
  }
  if (choices.names.empty()) {
    throw Failure(kUsage, "--solver names no solver; 'cairn list solvers' shows all");
  }
  const auto none_for = [](std::string_view what, std::string_view usual) {
    return Failure(kUsage, fmt::format("--solver: none of these solves {}; add one of {}", what,
                                       fmt::join(Split(usual, ','), ", ")));
  };
  if (kinds.matrices && choices.of_matrices.empty()) {
    throw none_for("problems in matrix form", kOfMatrices);
  }
  if (kinds.frames && choices.of_frames.empty()) throw none_for("recorded frames", kOfFrames);
  return choices;
}

}  // namespace cairn::cli
