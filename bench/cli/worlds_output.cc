// SPDX-License-Identifier: MIT
#include "cli/worlds_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/text_table.h"

namespace cairn::cli {
namespace {

using bench::Finding;
using bench::Oracle;
using bench::Trial;
using bench::Variant;
using bench::WorldResult;

constexpr std::string_view kShort[bench::kOracles] = {"fly",    "audit",    "restless", "gap",
                                                      "penetr", "momentum", "bits"};

bool Failed(const WorldResult& result, size_t variant, Oracle oracle) {
  return std::any_of(result.findings[variant].begin(), result.findings[variant].end(),
                     [&](const Finding& finding) { return finding.oracle == oracle; });
}

template <class Holds>
std::string Count(std::span<const WorldResult> results, Holds holds) {
  return fmt::format("{}", std::count_if(results.begin(), results.end(), holds));
}

/// "4.2", "inf" if it never came, "-" where there is none.
std::string Median(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return "-";
  std::sort(values.begin(), values.end());
  const double median = values[values.size() / 2];
  return std::isinf(median) ? "never" : fmt::format("{:.2f}", median);
}

template <class GetTrial>
std::vector<std::string> TimeCells(std::span<const WorldResult> results, GetTrial get) {
  std::vector<double> asleep;
  double cpu = 0;
  for (const WorldResult& result : results) {
    asleep.push_back(get(result).asleep_at);
    cpu += get(result).cpu_seconds;
  }
  return {Median(asleep), fmt::format("{:.1f}", 1e3 * cpu / double(results.size()))};
}

TextTable TotalTable(std::span<const WorldResult> results, std::span<const Variant> variants) {
  TextTable table;
  table.columns = {{"solver", ""}};
  for (const std::string_view oracle : kShort) table.columns.push_back({std::string(oracle), ""});
  table.columns.push_back({"asleep", "median s"});
  table.columns.push_back({"CPU", "ms/world"});
  for (size_t i = 0; i < bench::Yardsticks().size(); ++i) {
    const auto trial = [i](const WorldResult& result) -> const Trial& { return result.bullet[i]; };
    std::vector<std::string> row = {bench::Yardsticks()[i].name};
    row.push_back(Count(results, [&](const WorldResult& result) {
      return !(trial(result).fastest <= Trial::kTooFast);
    }));
    row.push_back("-");
    row.push_back(i == 1 ? Count(results,
                                 [](const WorldResult& result) {
                                   return bench::IsBulletRestless(result.bullet);
                                 })
                         : "-");
    row.resize(table.columns.size() - 2, "-");
    for (std::string& cell : TimeCells(results, trial)) row.push_back(std::move(cell));
    table.rows.push_back(std::move(row));
  }
  for (size_t i = 0; i < variants.size(); ++i) {
    std::vector<std::string> row = {variants[i].name};
    for (int oracle = 0; oracle < bench::kOracles; ++oracle) {
      row.push_back(Count(results, [&](const WorldResult& result) {
        return Failed(result, i, static_cast<Oracle>(oracle));
      }));
    }
    for (std::string& cell :
         TimeCells(results, [i](const WorldResult& r) -> const Trial& { return r.trials[i]; })) {
      row.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// "2 fly, 1 gap"; "-" if nothing failed.
std::string Failures(std::span<const WorldResult> results, size_t variant) {
  std::string text;
  for (int oracle = 0; oracle < bench::kOracles; ++oracle) {
    const std::string count = Count(results, [&](const WorldResult& result) {
      return Failed(result, variant, static_cast<Oracle>(oracle));
    });
    if (count == "0") continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, kShort[oracle]);
  }
  return text.empty() ? "-" : text;
}

TextTable KindTable(std::span<const WorldResult> results, std::span<const Variant> variants) {
  TextTable table;
  table.columns = {{"kind", ""}, {"worlds", ""}, {"bullet", ""}};
  table.names = 1;
  for (const Variant& variant : variants) table.columns.push_back({variant.name, ""});
  for (const bench::Kind& kind : bench::Kinds()) {
    std::vector<WorldResult> own;
    std::copy_if(results.begin(), results.end(), std::back_inserter(own),
                 [&](const WorldResult& result) { return result.kind == &kind; });
    if (own.empty()) continue;
    const auto flies = std::count_if(own.begin(), own.end(), [](const WorldResult& result) {
      return bench::DoesBulletFlyApart(result.bullet);
    });
    std::vector<std::string> row = {std::string(kind.name), fmt::format("{}", own.size()),
                                    flies == 0 ? "-" : fmt::format("{} fly", flies)};
    for (size_t i = 0; i < variants.size(); ++i) row.push_back(Failures(own, i));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<std::string> ReportRow(const std::string& name, const Trial& trial) {
  const auto audit = trial.audits == 0 ? std::string("-")
                                       : fmt::format("{}/{}", trial.audits_violated, trial.audits);
  return {name,
          fmt::format("{}", trial.frames),
          fmt::format("{:.3g}", trial.fastest),
          trial.wild_frame < 0 ? "-" : fmt::format("{}", trial.wild_frame),
          fmt::format("{:.3g}", trial.late_fastest),
          fmt::format("{:.3g}", trial.gap),
          fmt::format("{:.3g}", trial.penetration),
          fmt::format("{:.4g}", trial.energy),
          fmt::format("{}/{}", trial.steps_kept, trial.steps_undone),
          audit,
          trial.audits == 0
              ? "-"
              : fmt::format("{:.3g} in {}", trial.worst_audit.merit, trial.worst_frame),
          std::isnan(trial.asleep_at)   ? "-"
          : std::isinf(trial.asleep_at) ? "never"
                                        : fmt::format("{:.2f}", trial.asleep_at),
          fmt::format("{:.1f}", 1e3 * trial.cpu_seconds)};
}

}  // namespace

std::string WorldTables(std::span<const WorldResult> results, std::span<const Variant> variants) {
  if (results.empty()) return "";
  return TotalTable(results, variants).ToText() + "\n" + KindTable(results, variants).ToText();
}

std::string FailedWorlds(std::span<const WorldResult> results, std::span<const Variant> variants) {
  std::string text;
  for (const WorldResult& result : results) {
    for (size_t i = 0; i < variants.size(); ++i) {
      if (result.findings[i].empty()) continue;
      text += fmt::format("seed {} ({}), {}:", result.seed, result.kind->name, variants[i].name);
      std::string_view separator = " ";
      for (const Finding& finding : result.findings[i]) {
        text += fmt::format("{}{} {:.3g} > {:.3g}", separator, NameOf(finding.oracle),
                            finding.value, finding.line);
        separator = ", ";
      }
      text += "\n";
    }
  }
  return text;
}

std::string WorldReport(const WorldResult& result, const std::string& description,
                        std::span<const Variant> variants) {
  TextTable table;
  table.columns = {{"solver", ""},   {"frames", ""},    {"fastest", "m/s"}, {"wild", "frame"},
                   {"late", "m/s"},  {"gap", "m"},      {"penetr", "m"},    {"energy", "J"},
                   {"steps", "+/-"}, {"audits", "bad"}, {"worst", "J"},     {"asleep", "s"},
                   {"CPU", "ms"}};
  for (size_t i = 0; i < result.bullet.size(); ++i) {
    table.rows.push_back(ReportRow(bench::Yardsticks()[i].name, result.bullet[i]));
  }
  for (size_t i = 0; i < variants.size(); ++i) {
    table.rows.push_back(ReportRow(variants[i].name, result.trials[i]));
  }
  return fmt::format("seed {}, {}\n\n{}", result.seed, description, table.ToText());
}

}  // namespace cairn::cli
