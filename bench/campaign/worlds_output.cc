// SPDX-License-Identifier: MIT
#include "campaign/campaign_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "support/text_table.h"

namespace cairn::cli {
namespace {

using bench::Finding;
using bench::Oracle;
using bench::Trial;
using bench::Variant;
using bench::WorldResult;

constexpr size_t kTen = 1;  // of BulletVariants()
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

/// Worlds that fell asleep of those that may, the median time until then of worlds that do with ten
/// iterations of Bullet, and the mean cost.
template <class GetTrial>
std::vector<std::string> TimeCells(std::span<const WorldResult> results, GetTrial get) {
  std::vector<double> times;
  int may = 0, asleep = 0;
  double cpu = 0;
  for (const WorldResult& result : results) {
    const Trial& trial = get(result);
    cpu += trial.cpu_seconds;
    may += !std::isnan(trial.asleep_at);
    asleep += std::isfinite(trial.asleep_at);
    if (std::isfinite(result.bullet[kTen].asleep_at)) times.push_back(trial.asleep_at);
  }
  std::sort(times.begin(), times.end());
  const double median = times.empty() ? NAN : times[times.size() / 2];
  return {fmt::format("{}/{}", asleep, may),
          std::isnan(median)   ? "-"
          : std::isinf(median) ? "never"
                               : fmt::format("{:.2f}", median),
          fmt::format("{:.1f}", 1e3 * cpu / double(results.size()))};
}

/// A line of a run of Bullet: of oracles only what it is asked for.
std::vector<std::string> BulletRow(std::span<const WorldResult> results, size_t index) {
  std::vector<std::string> row = {bench::BulletVariants()[index].name};
  row.resize(1 + bench::kOracles, "-");
  row[1 + size_t(Oracle::kFliesApart)] = Count(results, [&](const WorldResult& result) {
    return !(result.bullet[index].fastest <= Trial::kTooFast);
  });
  if (index == kTen) {
    row[1 + size_t(Oracle::kRestless)] = Count(
        results, [](const WorldResult& result) { return bench::IsBulletRestless(result.bullet); });
  }
  for (std::string& cell :
       TimeCells(results, [&](const WorldResult& r) -> const Trial& { return r.bullet[index]; })) {
    row.push_back(std::move(cell));
  }
  return row;
}

TextTable TotalTable(std::span<const WorldResult> results, std::span<const Variant> variants,
                     bool bits) {
  TextTable table;
  table.columns = {{"solver", ""}};
  for (const std::string_view oracle : kShort) table.columns.push_back({std::string(oracle), ""});
  table.columns.insert(table.columns.end(),
                       {{"asleep", ""}, {"after", "median s"}, {"CPU", "ms/world"}});
  for (size_t i = 0; i < bench::BulletVariants().size(); ++i) {
    table.rows.push_back(BulletRow(results, i));
  }
  for (size_t i = 0; i < variants.size(); ++i) {
    std::vector<std::string> row = {variants[i].name};
    for (int oracle = 0; oracle < bench::kOracles; ++oracle) {
      if (static_cast<Oracle>(oracle) == Oracle::kBits && !bits) {
        row.push_back("-");
        continue;
      }
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
          trial.audits == 0 ? "-"
          : trial.worst_frame < 0
              ? "none above 0"
              : fmt::format("{:.3g} in {}", trial.worst_audit.merit, trial.worst_frame),
          std::isnan(trial.asleep_at)   ? "-"
          : std::isinf(trial.asleep_at) ? "never"
                                        : fmt::format("{:.2f}", trial.asleep_at),
          fmt::format("{:.1f}", 1e3 * trial.cpu_seconds)};
}

}  // namespace

std::string WorldTables(std::span<const WorldResult> results, std::span<const Variant> variants,
                        bool bits) {
  if (results.empty()) return "";
  return TotalTable(results, variants, bits).ToText() + "\n" +
         KindTable(results, variants).ToText();
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
      const bool fast =
          std::any_of(result.findings[i].begin(), result.findings[i].end(),
                      [](const Finding& finding) { return IsOfSpeed(finding.oracle); });
      if (fast && result.converged) {
        text += fmt::format(" ({}: fastest {:.3g}, in the last quarter {:.3g})",
                            bench::ConvergedBullet().name, result.converged->fastest,
                            result.converged->late_fastest);
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
    table.rows.push_back(ReportRow(bench::BulletVariants()[i].name, result.bullet[i]));
  }
  for (size_t i = 0; i < variants.size(); ++i) {
    table.rows.push_back(ReportRow(variants[i].name, result.trials[i]));
  }
  return fmt::format("seed {}, {}\n\n{}", result.seed, description, table.ToText());
}

}  // namespace cairn::cli
