// SPDX-License-Identifier: MIT
#include "contestants/solver_registry.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "contestants/bullet_contestants.h"
#include "contestants/cairn_contestants.h"
#include "support/failure.h"
#include "support/names.h"

namespace cairn::cli {
namespace {

constexpr int kMostIterations = 100000;

template <class T>
std::unique_ptr<Contestant> Make() {
  return std::make_unique<T>();
}

std::unique_ptr<Contestant> MakeCairn() { return std::make_unique<CairnContestant>(Settings{}); }

std::unique_ptr<Contestant> MakeCairnPgs() {
  return std::make_unique<CairnContestant>(Settings{.k_sm = 0});
}

SolverChoice ParseSolver(std::string_view word, std::span<const std::string> names) {
  const size_t at = word.find('@');
  const std::string_view name = word.substr(0, at);
  const SolverEntry& entry =
      Solvers()[FindName("solver", name, names, "'cairn list solvers' shows all")];
  SolverChoice choice{.entry = &entry, .own_iterations = {}, .label = entry.name};
  if (at == std::string_view::npos) return choice;

  choice.own_iterations = ParseIterations(entry.name + "@", word.substr(at + 1));
  choice.label += word.substr(at);
  if (choice.own_iterations->kind == IterationRule::Kind::kFit &&
      entry.control != Control::kIterations) {
    throw Failure(kUsage, fmt::format("{}: only solvers that count iterations can be fitted to a "
                                      "budget; this one {}",
                                      choice.label,
                                      entry.control == Control::kClock ? "keeps time itself"
                                                                       : "ends when it is done"));
  }
  return choice;
}

}  // namespace

std::span<const SolverEntry> Solvers() {
  using enum Control;
  static const std::vector<SolverEntry> solvers = {
      {"bullet-si", "Bullet's default: sequential impulses, which is projected Gauss-Seidel",
       Maker::kBullet, kIterations, &Make<SequentialImpulses>},
      {"bullet-nncg", "Bullet's nonlinear conjugate gradients on all rows", Maker::kBullet,
       kIterations, &Make<Nncg>},
      {"bullet-dantzig", "Bullet's direct solver on dense matrices, one per island", Maker::kBullet,
       kNone, &Make<Dantzig>},
      {"bullet-pgs-mlcp", "Bullet's projected Gauss-Seidel on dense matrices, one per island",
       Maker::kBullet, kIterations, &Make<PgsMlcp>},
      {"bullet-si-substeps4",
       "sequential impulses in four substeps, a quarter of the iterations in each", Maker::kBullet,
       kIterations, &Make<QuarterImpulses>, QuarterImpulses::kParts},
      {"cairn", "Cairn: sweeps, and subspace steps where they pay", Maker::kCairn, kClock,
       &MakeCairn},
      {"cairn-pgs", "Cairn without subspace steps: accelerated sweeps", Maker::kCairn, kClock,
       &MakeCairnPgs},
  };
  return solvers;
}

IterationRule ParseIterations(std::string_view option, std::string_view text) {
  if (text == "fit") return {.kind = IterationRule::Kind::kFit, .count = 10};
  int count = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, count);
  if (error != std::errc{} || rest != end || count < 1 || count > kMostIterations) {
    throw Failure(kUsage, fmt::format("{} '{}': write a number of iterations from 1 to {}, or fit "
                                      "for as many as the budget allows",
                                      option, text, kMostIterations));
  }
  return {.kind = IterationRule::Kind::kFixed, .count = count};
}

std::vector<SolverChoice> ParseSolvers(std::string_view list) {
  std::vector<std::string> names;
  for (const SolverEntry& entry : Solvers()) names.push_back(entry.name);
  std::vector<SolverChoice> choices;
  for (const std::string& word : Split(list, ',')) {
    SolverChoice choice = ParseSolver(word, names);
    if (std::any_of(choices.begin(), choices.end(),
                    [&](const SolverChoice& other) { return other.label == choice.label; })) {
      throw Failure(kUsage, fmt::format("--solver names {} twice", choice.label));
    }
    choices.push_back(std::move(choice));
  }
  if (choices.empty())
    throw Failure(kUsage, "--solver names no solver; 'cairn list solvers' shows all");
  return choices;
}

}  // namespace cairn::cli
