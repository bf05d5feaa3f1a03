// SPDX-License-Identifier: MIT
#include "small/small.h"

#include <fmt/format.h>

#include <cmath>

#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::cli {
namespace {

constexpr size_t kFirst = 1;  // of SmallSolvers() that is compared

std::string Ratio(double value) {
  if (std::isnan(value)) return "-";
  return value < 0.1 ? fmt::format("{:.2g}", value) : fmt::format("{:.2f}", value);
}

std::string Microseconds(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.1f}", value);
}

double GeometricMean(std::span<const SmallResult> worlds, size_t solver,
                     double (*ratio)(const SmallResult&, size_t)) {
  std::vector<double> logarithms;
  for (const SmallResult& world : worlds) {
    // a solver that is exact where Bullet is not would make the mean 0
    logarithms.push_back(std::log(std::max(ratio(world, solver), 1e-6)));
  }
  return std::exp(Mean(logarithms));
}

/// The ratios of all solvers that are compared.
template <class RatioOf>
void AddRatios(RatioOf ratio, std::vector<std::string>* row) {
  for (size_t i = kFirst; i < SmallSolvers().size(); ++i) row->push_back(Ratio(ratio(i)));
}

std::vector<std::string> Row(const SmallResult& world) {
  const SmallSolver& bullet = world.solvers.front();
  std::vector<std::string> row = {world.name, fmt::format("{}", world.bodies),
                                  fmt::format("{:.0f}", world.points),
                                  fmt::format("{}", world.joints), Microseconds(bullet.hot)};
  AddRatios([&](size_t solver) { return HotRatio(world, solver); }, &row);
  row.push_back(Microseconds(bullet.cold));
  AddRatios([&](size_t solver) { return ColdRatio(world, solver); }, &row);
  row.push_back(FormatNumber(Median(bullet.errors)));
  AddRatios([&](size_t solver) { return ErrorRatio(world, solver); }, &row);
  return row;
}

std::vector<std::string> MeanRow(std::span<const SmallResult> worlds) {
  std::vector<std::string> row = {"geometric mean", "", "", "", ""};
  AddRatios([&](size_t solver) { return GeometricMean(worlds, solver, &HotRatio); }, &row);
  row.push_back("");
  AddRatios([&](size_t solver) { return GeometricMean(worlds, solver, &ColdRatio); }, &row);
  row.push_back("");
  AddRatios([&](size_t solver) { return GeometricMean(worlds, solver, &ErrorRatio); }, &row);
  return row;
}

}  // namespace

TextTable SmallTable(std::span<const SmallResult> worlds) {
  TextTable table;
  table.columns = {{"world", ""},     {"bodies", ""},        {"points", ""},
                   {"joints", ""},    {"Bullet", "us hot"},  {"sweeps", "hot"},
                   {"cairn", "hot"},  {"Bullet", "us cold"}, {"sweeps", "cold"},
                   {"cairn", "cold"}, {"Bullet", "err m/s"}, {"sweeps", "error"},
                   {"cairn", "error"}};
  for (const SmallResult& world : worlds) {
    table.rows.push_back(Row(world));
    for (size_t i = 0; i < world.solvers.size(); ++i) {
      const std::optional<SolverFailure>& failure = world.solvers[i].failure;
      if (!failure) continue;
      table.rows.push_back({"", fmt::format("{} FAILED at frame {}: {}", SmallSolvers()[i].label,
                                            failure->frame, failure->reason)});
    }
  }
  if (worlds.size() > 1) table.rows.push_back(MeanRow(worlds));
  return table;
}

std::string SmallReadingHelp(const SmallOptions& options, const RunContext& context) {
  return fmt::format(
      "Bullet: median time of a substep, from prepareSolve() to allSolved(), with its ten\n"
      "iterations. sweeps (no subspace steps) and cairn (as it comes): the same as a share of\n"
      "Bullet's; below 1 is faster. hot: worlds of their own, stepped in turn; cold: caches "
      "emptied\n"
      "before each step. error: largest velocity error of a body against a converged reference, "
      "all\n"
      "given the same states, Bullet's median and shares of it; '-': Bullet's is below {:g} m/s.\n"
      "points: of contact; they and times are medians of {} frames, times of those in which\n"
      "the thread kept its core.\n"
      "Compared with {}.\nMachine: {}, {}.\nRun: {} frames, the first {} of which do not count;\n"
      "{}; {} instructions{}.\n",
      kLeastError, options.frames - options.warmup, DescribeBullet(context.build),
      context.machine.cpu, context.noise.verdict, options.frames, options.warmup,
      Describe(options.setup), context.simd_target,
      options.setup.simd.empty() ? "" : " by request");
}

}  // namespace cairn::cli
