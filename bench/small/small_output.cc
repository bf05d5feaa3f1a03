// SPDX-License-Identifier: MIT
#include "small/small.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "support/statistics.h"
#include "support/text_table.h"
#include "worlds/random_world.h"

namespace cairn::cli {
namespace {

constexpr size_t kFirst = 1;  // of SmallSolvers() that is compared

constexpr const char* kOfRandom =
    "kind: medians over its worlds, of ratios geometric means. Then, by their number of bodies, "
    "in\n"
    "how many worlds cairn's share of Bullet's time or error is at most so much; 90 %: of nine in "
    "ten\nat most. Then the slowest beside Bullet, hot, with their seeds.\n";

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

std::vector<std::string> Row(const SmallResult& world, const std::string& name) {
  const SmallSolver& bullet = world.solvers.front();
  std::vector<std::string> row = {name, fmt::format("{}", world.bodies),
                                  fmt::format("{:.0f}", world.points),
                                  fmt::format("{}", world.joints), Microseconds(bullet.hot)};
  AddRatios([&](size_t solver) { return HotRatio(world, solver); }, &row);
  row.push_back(Microseconds(bullet.cold));
  AddRatios([&](size_t solver) { return ColdRatio(world, solver); }, &row);
  row.push_back(FormatNumber(Median(bullet.errors)));
  AddRatios([&](size_t solver) { return ErrorRatio(world, solver); }, &row);
  return row;
}

/// Medians and geometric means of several worlds; no medians where `name` is of all of them.
std::vector<std::string> MeanRow(std::span<const SmallResult> worlds, const std::string& name,
                                 bool medians) {
  const auto median = [&](auto value) {
    std::vector<double> values;
    for (const SmallResult& world : worlds) values.push_back(static_cast<double>(value(world)));
    return medians ? Median(values) : kNotMeasured;
  };
  const auto count = [](double value) {
    return std::isnan(value) ? std::string() : fmt::format("{:.0f}", value);
  };
  const auto time = [](double value) {
    return std::isnan(value) ? std::string() : Microseconds(value);
  };
  const auto first = [](const SmallResult& world) -> const SmallSolver& {
    return world.solvers.front();
  };
  std::vector<std::string> row = {
      name, count(median([](const SmallResult& world) { return world.bodies; })),
      count(median([](const SmallResult& world) { return world.points; })),
      count(median([](const SmallResult& world) { return world.joints; })),
      time(median([&](const SmallResult& world) { return first(world).hot; }))};
  AddRatios([&](size_t solver) { return GeometricMean(worlds, solver, &HotRatio); }, &row);
  row.push_back(time(median([&](const SmallResult& world) { return first(world).cold; })));
  AddRatios([&](size_t solver) { return GeometricMean(worlds, solver, &ColdRatio); }, &row);
  const double error =
      median([&](const SmallResult& world) { return Median(first(world).errors); });
  row.push_back(medians ? FormatNumber(error) : "");
  AddRatios([&](size_t solver) { return GeometricMean(worlds, solver, &ErrorRatio); }, &row);
  return row;
}

TextTable EmptyTable() {
  TextTable table;
  table.columns = {{"world", ""},     {"bodies", ""},        {"points", ""},
                   {"joints", ""},    {"Bullet", "us hot"},  {"sweeps", "hot"},
                   {"cairn", "hot"},  {"Bullet", "us cold"}, {"sweeps", "cold"},
                   {"cairn", "cold"}, {"Bullet", "err m/s"}, {"sweeps", "error"},
                   {"cairn", "error"}};
  return table;
}

void AddWorld(const SmallResult& world, const std::string& name, TextTable* table) {
  table->rows.push_back(Row(world, name));
  for (size_t i = 0; i < world.solvers.size(); ++i) {
    const std::optional<SolverFailure>& failure = world.solvers[i].failure;
    if (!failure) continue;
    table->rows.push_back({"", fmt::format("{} FAILED at frame {}: {}", SmallSolvers()[i].label,
                                           failure->frame, failure->reason)});
  }
}

/// Ratios of a solver in all worlds with so many bodies, without those that have none.
std::vector<double> RatiosOf(std::span<const SmallResult> worlds, int least, int most,
                             double (*ratio)(const SmallResult&, size_t), size_t solver) {
  std::vector<double> ratios;
  for (const SmallResult& world : worlds) {
    if (world.bodies >= least && world.bodies <= most) ratios.push_back(ratio(world, solver));
  }
  return Measured(ratios);
}

std::string ShareUpTo(double most, std::span<const double> values) {
  const auto count =
      std::count_if(values.begin(), values.end(), [most](double value) { return value <= most; });
  return fmt::format("{:.0f} %",
                     100 * static_cast<double>(count) / static_cast<double>(values.size()));
}

}  // namespace

TextTable SmallTable(std::span<const SmallResult> worlds) {
  TextTable table = EmptyTable();
  const std::vector<SceneChoice> usual = SmallWorlds();
  for (const SmallResult& world : worlds) {
    const bool is_usual = std::any_of(usual.begin(), usual.end(), [&world](const auto& scene) {
      return scene.info->name == world.name && scene.size == world.size;
    });
    AddWorld(world, is_usual ? world.name : fmt::format("{}:{}", world.name, world.size), &table);
  }
  if (worlds.size() > 1) table.rows.push_back(MeanRow(worlds, "geometric mean", false));
  return table;
}

TextTable KindsTable(std::span<const SmallResult> worlds) {
  TextTable table = EmptyTable();
  table.columns.front().name = "kind";
  for (const bench::Kind& kind : bench::Kinds()) {
    std::vector<SmallResult> of_kind;
    for (const SmallResult& world : worlds) {
      if (world.name == kind.name) of_kind.push_back(world);
    }
    if (!of_kind.empty()) table.rows.push_back(MeanRow(of_kind, std::string(kind.name), true));
  }
  table.rows.push_back(MeanRow(worlds, "all", true));
  return table;
}

TextTable SharesTable(std::span<const SmallResult> worlds) {
  struct Measure {
    const char* name;
    double (*ratio)(const SmallResult&, size_t);
  };
  TextTable table = TableOf(
      {"cairn, of Bullet's", "bodies", "worlds", "median", "90 %", "largest", "<= 0.7", "<= 1"});
  for (const Measure& measure :
       {Measure{"time hot", &HotRatio}, {"time cold", &ColdRatio}, {"error", &ErrorRatio}}) {
    for (const auto& [name, least, most] :
         {std::tuple{"< 20", 0, 19}, {">= 20", 20, std::numeric_limits<int>::max()}}) {
      const std::vector<double> ratios =
          RatiosOf(worlds, least, most, measure.ratio, SmallSolvers().size() - 1);
      if (ratios.empty()) continue;
      table.rows.push_back({measure.name, name, fmt::format("{}", ratios.size()),
                            Ratio(Median(ratios)), Ratio(Quantile(ratios, 0.9)),
                            Ratio(Largest(ratios)), ShareUpTo(0.7, ratios), ShareUpTo(1, ratios)});
    }
  }
  return table;
}

TextTable SlowestTable(std::span<const SmallResult> worlds, int count) {
  std::vector<const SmallResult*> order;
  for (const SmallResult& world : worlds) {
    if (!std::isnan(HotRatio(world, SmallSolvers().size() - 1))) order.push_back(&world);
  }
  std::stable_sort(order.begin(), order.end(), [](const SmallResult* a, const SmallResult* b) {
    return HotRatio(*a, SmallSolvers().size() - 1) > HotRatio(*b, SmallSolvers().size() - 1);
  });
  TextTable table = EmptyTable();
  for (const SmallResult* world : order) {
    if (table.rows.size() == static_cast<size_t>(count)) break;
    AddWorld(*world, fmt::format("{} {}", world->name, world->size), &table);
  }
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
      "the thread kept its core.\n{}"
      "Compared with {}.\nMachine: {}, {}.\nRun: {} frames, the first {} of which do not count;\n"
      "{}; {} instructions{}.\n",
      kLeastError, options.frames - options.warmup, options.random ? kOfRandom : "",
      DescribeBullet(context.build), context.machine.cpu, context.noise.verdict, options.frames,
      options.warmup, Describe(options.setup), context.simd_target,
      options.setup.simd.empty() ? "" : " by request");
}

}  // namespace cairn::cli
