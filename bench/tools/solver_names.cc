// SPDX-License-Identifier: MIT
#include "tools/solver_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "contestants/solver_registry.h"
#include "lcp/lcp_solvers.h"
#include "rows/row_solvers.h"
#include "support/failure.h"
#include "support/names.h"
#include "worlds/variants.h"

namespace cairn::cli {
namespace {

using enum SolverUser;

constexpr SolverUser kUsers[] = {kRun, kWorlds, kSolve};
constexpr std::string_view kCommands[] = {"run", "worlds", "solve"};

/// The same solver in each of them. Solvers that have the same name everywhere are not listed.
constexpr std::array<std::string_view, std::size(kUsers)> kSame[] = {
    {"cairn", "cairn", "pgs-sm"}, {"cairn-pgs", "cairn-sweeps", "pgs-nncg"}};

/// What is not the same, and near to a line of kSame.
constexpr std::pair<std::string_view, size_t> kNear[] = {
    {"pgs-sm-literal", 0}, {"cairn-work", 0}, {"cairn-always", 0},
    {"cairn-parts", 0},    {"pgs", 1},        {"psor", 1}};

template <class Entries>
void AddNames(const Entries& entries, std::vector<std::string>* names) {
  for (const auto& entry : entries) {
    if (std::ranges::find(*names, entry.name) == names->end()) names->push_back(entry.name);
  }
}

std::vector<std::string> OwnNames(SolverUser user) {
  std::vector<std::string> names;
  if (user == kRun) AddNames(Solvers(), &names);
  if (user == kWorlds) AddNames(bench::CairnVariants(), &names);
  if (user == kSolve) AddNames(LcpSolvers(), &names);
  if (user == kSolve) AddNames(RowSolvers(), &names);
  return names;
}

bool Contains(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

/// Why a solver of another command cannot be had here.
Failure OfAnother(SolverUser user, std::string_view name, const std::vector<std::string>& owners) {
  std::string near;
  for (const auto& [other, line] : kNear) {
    if (other == name) near = fmt::format("; {} comes nearest", kSame[line][size_t(user)]);
  }
  return {kUsage,
          fmt::format("'{}' is a solver of cairn {}, and cairn {} has none that does the "
                      "same{}: 'cairn list solvers' shows all",
                      name, fmt::join(owners, " and cairn "), kCommands[size_t(user)], near)};
}

/// @param name  without iterations of its own
std::string OwnName(SolverUser user, std::string_view name) {
  const std::vector<std::string> own = OwnNames(user);
  if (Contains(own, name)) return std::string(name);
  for (const auto& same : kSame) {
    if (std::ranges::find(same, name) != same.end()) return std::string(same[size_t(user)]);
  }
  if (user == SolverUser::kWorlds && name.starts_with("bullet")) {
    throw Failure(kUsage, fmt::format("'{}': cairn worlds runs Bullet beside all others anyway; "
                                      "--solver names those of Cairn",
                                      name));
  }
  std::vector<std::string> owners;
  for (const SolverUser other : kUsers) {
    if (Contains(OwnNames(other), name)) owners.emplace_back(kCommands[size_t(other)]);
  }
  if (!owners.empty()) throw OfAnother(user, name, owners);
  constexpr std::string_view kHelp = "'cairn list solvers' shows all";
  const bool is_start = std::ranges::any_of(
      own, [&](const std::string& known) { return !name.empty() && known.starts_with(name); });
  if (is_start) return own[FindName("solver", name, own, kHelp)];
  std::vector<std::string> all = own;
  for (const std::string& known : own)
    std::ranges::copy(Aliases(user, known), std::back_inserter(all));
  throw Failure(kUsage,
                fmt::format("unknown solver '{}': {}{}", name, DidYouMean(name, all), kHelp));
}

}  // namespace

std::vector<std::string> Aliases(SolverUser user, std::string_view name) {
  std::vector<std::string> aliases;
  for (const auto& same : kSame) {
    if (same[size_t(user)] != name) continue;
    for (const std::string_view other : same) {
      if (other != name && !Contains(aliases, other)) aliases.emplace_back(other);
    }
  }
  return aliases;
}

std::string OwnSolverNames(SolverUser user, std::string_view list) {
  std::string names;
  for (const std::string& word : Split(list, ',')) {
    const size_t end = user == kRun ? std::min(word.find('@'), word.size()) : word.size();
    if (!names.empty()) names += ',';
    names += OwnName(user, std::string_view(word).substr(0, end)) + word.substr(end);
  }
  return names;
}

}  // namespace cairn::cli
