// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "campaign/campaign_output.h"
#include "support/text_table.h"

namespace cairn::cli {
namespace {

/// A number of a run; ratios are of those above a floor, below which it means nothing.
struct Measure {
  const char* name;
  double bench::Trial::*value;
  double floor;
};
constexpr Measure kMeasures[] = {{"gap", &bench::Trial::gap, 1e-3},
                                 {"penetr", &bench::Trial::penetration, 1e-3},
                                 {"late", &bench::Trial::late_fastest, 1e-2},
                                 {"CPU", &bench::Trial::cpu_seconds, 0}};
/// What counts as smaller or larger, in logarithms.
constexpr double kTenth = 0.1;
/// Beside Bullet, what is below this share of a floor counts as that: some solvers leave nothing.
constexpr double kLeastBeside = 0.01;

/// Mean and counts of the ratios of one measure.
class Ratios {
 public:
  explicit Ratios(const Measure& measure) : measure_(measure) {}

  /// Where either means nothing, nothing is added.
  void Add(const bench::Trial& before, const bench::Trial& after) {
    if (after.*measure_.value > measure_.floor) AddAtLeast(0, before, after);
  }
  /// What is below a share of the floor counts as that.
  void AddAtLeast(double share, const bench::Trial& before, const bench::Trial& after) {
    const double old_value = before.*measure_.value;
    if (!(old_value > measure_.floor)) return;
    const double value = std::max(after.*measure_.value, share * measure_.floor);
    const double ratio = std::log(value / old_value);
    if (!std::isfinite(ratio)) return;
    ++count_;
    sum_ += ratio;
    smaller_ += ratio < -kTenth ? 1 : 0;
    larger_ += ratio > kTenth ? 1 : 0;
  }

  std::string Mean() const {
    return count_ == 0 ? "-" : fmt::format("{:.3f}", std::exp(sum_ / count_));
  }
  std::string Counts() const { return count_ == 0 ? "-" : fmt::format("{}/{}", smaller_, larger_); }

 private:
  const Measure& measure_;
  double sum_ = 0;
  int count_ = 0, smaller_ = 0, larger_ = 0;
};

/// A ratio for each measure.
struct AllRatios {
  AllRatios() {
    for (const Measure& measure : kMeasures) of.emplace_back(measure);
  }
  void AppendTo(std::vector<std::string>* row) const {
    for (const Ratios& ratios : of) {
      row->push_back(ratios.Mean());
      row->push_back(ratios.Counts());
    }
  }
  std::vector<Ratios> of;
};

void AddColumns(TextTable* table) {
  for (const Measure& measure : kMeasures) {
    table->columns.push_back({measure.name, "ratio"});
    table->columns.push_back({"", "-/+"});
  }
}

/// One solver's line; none where it was not run before.
class Line {
 public:
  explicit Line(std::string solver) : solver_(std::move(solver)) {}

  void Add(const EarlierRuns& earlier, std::uint64_t seed, const bench::Trial& trial) {
    const auto world = earlier.find(seed);
    if (world == earlier.end()) return;
    const auto before = world->second.find(solver_);
    if (before == world->second.end()) return;
    ++worlds_;
    if (before->second.hash == trial.hash) return;
    ++differ_;
    for (Ratios& ratios : ratios_.of) ratios.Add(before->second, trial);
  }

  void AppendTo(TextTable* table) const {
    if (worlds_ == 0) return;
    std::vector<std::string> row = {solver_, fmt::format("{}", worlds_),
                                    fmt::format("{}", differ_)};
    ratios_.AppendTo(&row);
    table->rows.push_back(std::move(row));
  }

 private:
  std::string solver_;
  int worlds_ = 0, differ_ = 0;
  AllRatios ratios_;
};

/// A line of the table beside Bullet.
template <class GetTrial>
std::vector<std::string> BesideRow(const std::string& solver,
                                   std::span<const bench::WorldResult> results, GetTrial get) {
  AllRatios all;
  for (const bench::WorldResult& result : results) {
    for (Ratios& ratios : all.of) {
      ratios.AddAtLeast(kLeastBeside, result.bullet.front(), get(result));
    }
  }
  std::vector<std::string> row = {solver};
  all.AppendTo(&row);
  return row;
}

}  // namespace

std::string BesideTable(std::span<const bench::WorldResult> results,
                        std::span<const bench::Variant> variants) {
  TextTable table;
  const auto bullet = bench::BulletVariants();
  table.columns = {{"of " + bullet.front().name + "'s", ""}};
  AddColumns(&table);
  for (size_t i = 1; i < bullet.size(); ++i) {
    table.rows.push_back(
        BesideRow(bullet[i].name, results, [i](const auto& result) { return result.bullet[i]; }));
  }
  for (size_t i = 0; i < variants.size(); ++i) {
    table.rows.push_back(
        BesideRow(variants[i].name, results, [i](const auto& result) { return result.trials[i]; }));
  }
  return table.ToText();
}

std::string AgainstTable(std::span<const bench::WorldResult> results,
                         std::span<const bench::Variant> variants, const EarlierRuns& earlier) {
  TextTable table;
  table.columns = {{"against", ""}, {"worlds", ""}, {"other", "bits"}};
  AddColumns(&table);
  const auto bullet = bench::BulletVariants();
  for (size_t i = 0; i < bullet.size(); ++i) {
    Line line(bullet[i].name);
    for (const bench::WorldResult& result : results)
      line.Add(earlier, result.seed, result.bullet[i]);
    line.AppendTo(&table);
  }
  for (size_t i = 0; i < variants.size(); ++i) {
    Line line(variants[i].name);
    for (const bench::WorldResult& result : results)
      line.Add(earlier, result.seed, result.trials[i]);
    line.AppendTo(&table);
  }
  return table.rows.empty() ? "no world of --against is among these\n" : table.ToText();
}

}  // namespace cairn::cli
