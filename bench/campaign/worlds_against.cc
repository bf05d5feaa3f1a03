// SPDX-License-Identifier: MIT
#include <fmt/format.h>

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

/// Mean and counts of the ratios of one measure.
class Ratios {
 public:
  explicit Ratios(const Measure& measure) : measure_(measure) {}

  void Add(const bench::Trial& before, const bench::Trial& after) {
    const double old_value = before.*measure_.value, value = after.*measure_.value;
    if (!(old_value > measure_.floor && value > measure_.floor)) return;
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

/// One solver's line; none where it was not run before.
class Line {
 public:
  explicit Line(std::string solver) : solver_(std::move(solver)) {
    for (const Measure& measure : kMeasures) ratios_.emplace_back(measure);
  }

  void Add(const EarlierRuns& earlier, std::uint64_t seed, const bench::Trial& trial) {
    const auto world = earlier.find(seed);
    if (world == earlier.end()) return;
    const auto before = world->second.find(solver_);
    if (before == world->second.end()) return;
    ++worlds_;
    if (before->second.hash == trial.hash) return;
    ++differ_;
    for (Ratios& ratios : ratios_) ratios.Add(before->second, trial);
  }

  void AppendTo(TextTable* table) const {
    if (worlds_ == 0) return;
    std::vector<std::string> row = {solver_, fmt::format("{}", worlds_),
                                    fmt::format("{}", differ_)};
    for (const Ratios& ratios : ratios_) {
      row.push_back(ratios.Mean());
      row.push_back(ratios.Counts());
    }
    table->rows.push_back(std::move(row));
  }

 private:
  std::string solver_;
  int worlds_ = 0, differ_ = 0;
  std::vector<Ratios> ratios_;
};

}  // namespace

std::string AgainstTable(std::span<const bench::WorldResult> results,
                         std::span<const bench::Variant> variants, const EarlierRuns& earlier) {
  TextTable table;
  table.columns = {{"against", ""}, {"worlds", ""}, {"other", "bits"}};
  for (const Measure& measure : kMeasures) {
    table.columns.push_back({measure.name, "ratio"});
    table.columns.push_back({"", "-/+"});
  }
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
