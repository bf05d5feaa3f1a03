// SPDX-License-Identifier: MIT
#include "small/small.h"

#include <algorithm>

#include "support/statistics.h"

namespace cairn::cli {

std::span<const SolverChoice> SmallSolvers() {
  static const std::vector<SolverChoice> solvers = ParseSolvers("bullet-si,cairn-pgs,cairn");
  return solvers;
}

double HotRatio(const SmallResult& world, size_t solver) {
  return world.solvers[solver].hot / world.solvers.front().hot;
}

double ColdRatio(const SmallResult& world, size_t solver) {
  return world.solvers[solver].cold / world.solvers.front().cold;
}

double ErrorRatio(const SmallResult& world, size_t solver) {
  const std::vector<double>& errors = world.solvers[solver].errors;
  const std::vector<double>& of_first = world.solvers.front().errors;
  std::vector<double> ratios;
  for (size_t i = 0; i < errors.size(); ++i) {
    if (of_first[i] >= kLeastError) ratios.push_back(errors[i] / of_first[i]);
  }
  return Median(ratios);
}

bool AnyCairnFailed(std::span<const SmallResult> worlds) {
  for (const SmallResult& world : worlds) {
    for (size_t i = 0; i < world.solvers.size(); ++i) {
      const bool is_ours = SmallSolvers()[i].entry->maker == Maker::kCairn;
      if (is_ours && world.solvers[i].failure) return true;
    }
  }
  return false;
}

}  // namespace cairn::cli
