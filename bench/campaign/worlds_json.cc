// SPDX-License-Identifier: MIT
#include "campaign/campaign_output.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "support/failure.h"
#include "support/json_number.h"
#include "support/machine/run_context.h"

namespace cairn::cli {
namespace {

using Json = nlohmann::ordered_json;

Json ToJson(const bench::Trial& trial, const std::string& name,
            const std::vector<bench::Finding>& findings) {
  Json failures = Json::array();
  for (const bench::Finding& finding : findings) {
    failures.push_back({{"oracle", NameOf(finding.oracle)},
                        {"value", Number(finding.value)},
                        {"line", Number(finding.line)}});
  }
  return {{"solver", name},
          {"failures", failures},
          {"bodies", trial.bodies},
          {"joints", trial.joints},
          {"frames", trial.frames},
          {"wild_frame", trial.wild_frame},
          {"fastest_m_s", Number(trial.fastest)},
          {"late_fastest_m_s", Number(trial.late_fastest)},
          {"gap_m", Number(trial.gap)},
          {"penetration_m", Number(trial.penetration)},
          {"energy_j", Number(trial.energy)},
          {"steps_kept", trial.steps_kept},
          {"steps_undone", trial.steps_undone},
          {"audits", trial.audits},
          {"audits_violated", trial.audits_violated},
          {"worst_merit_j", Number(trial.worst_audit.merit)},
          {"worst_tolerance_j", Number(trial.worst_audit.tolerance)},
          {"worst_frame", trial.worst_frame},
          {"asleep_s", Number(trial.asleep_at)},
          {"linear_drift", Number(trial.linear_drift)},
          {"angular_drift", Number(trial.angular_drift)},
          {"hash", fmt::format("{:016x}", trial.hash)},
          {"cpu_s", Number(trial.cpu_seconds)}};
}

Json ToJson(const bench::WorldResult& result, const bench::CampaignOptions& options) {
  Json solvers = Json::array();
  for (size_t i = 0; i < result.bullet.size(); ++i) {
    solvers.push_back(ToJson(result.bullet[i], bench::BulletVariants()[i].name, {}));
  }
  if (result.converged) {
    solvers.push_back(ToJson(*result.converged, bench::ConvergedBullet().name, {}));
  }
  for (size_t i = 0; i < result.trials.size(); ++i) {
    solvers.push_back(ToJson(result.trials[i], options.variants[i].name, result.findings[i]));
  }
  return {{"seed", result.seed}, {"kind", result.kind->name}, {"solvers", solvers}};
}

/// What is not finite is null in JSON.
double NumberOr(const Json& json, double otherwise) {
  return json.is_null() ? otherwise : json.get<double>();
}

bench::Trial TrialOf(const Json& json) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  bench::Trial trial;
  trial.bodies = json.at("bodies");
  trial.joints = json.at("joints");
  trial.frames = json.at("frames");
  trial.wild_frame = json.at("wild_frame");
  trial.fastest = NumberOr(json.at("fastest_m_s"), kNan);
  trial.late_fastest = NumberOr(json.at("late_fastest_m_s"), kNan);
  trial.gap = NumberOr(json.at("gap_m"), kNan);
  trial.penetration = NumberOr(json.at("penetration_m"), kNan);
  trial.energy = NumberOr(json.at("energy_j"), kNan);
  trial.asleep_at = NumberOr(json.at("asleep_s"), std::numeric_limits<double>::infinity());
  trial.linear_drift = NumberOr(json.at("linear_drift"), kNan);
  trial.angular_drift = NumberOr(json.at("angular_drift"), kNan);
  trial.hash = std::stoull(json.at("hash").get<std::string>(), nullptr, 16);
  trial.cpu_seconds = NumberOr(json.at("cpu_s"), kNan);
  return trial;
}

/// By solver.
std::map<std::string, bench::Trial> TrialsOf(const Json& world) {
  std::map<std::string, bench::Trial> trials;
  for (const Json& solver : world.at("solvers")) {
    trials.insert_or_assign(solver.at("solver").get<std::string>(), TrialOf(solver));
  }
  return trials;
}

/// None if one is missing.
std::vector<bench::Trial> BulletOf(const std::map<std::string, bench::Trial>& all) {
  std::vector<bench::Trial> trials;
  for (const bench::Variant& variant : bench::BulletVariants()) {
    const auto found = all.find(variant.name);
    if (found == all.end()) return {};
    trials.push_back(found->second);
  }
  return trials;
}

/// Reads results of WorldsToJson(). @p read gets them; what it does not find is said to be no such
/// result. @throws Failure (kUsage)
template <class Read>
void ReadResults(std::string_view option, const std::string& path, Read read) {
  std::ifstream stream(path);
  if (!stream) {
    throw Failure(kUsage,
                  fmt::format("{} '{}' cannot be read: {}", option, path, std::strerror(errno)));
  }
  try {
    read(Json::parse(stream));
  } catch (const Json::exception&) {
    throw Failure(kUsage, fmt::format("{} '{}' is no result of cairn worlds --json", option, path));
  }
}

void CheckLength(const Json& json, const bench::CampaignOptions& options, std::string_view option,
                 const std::string& path) {
  if (json.at("seconds") == options.trial.seconds) return;
  throw Failure(
      kUsage, fmt::format("{} '{}': its worlds are {} s long, these {} s; --seconds says how long",
                          option, path, json.at("seconds").dump(), options.trial.seconds));
}

/// Worlds of another length, or another Bullet, say nothing.
void CheckContext(const Json& json, const bench::CampaignOptions& options,
                  const std::string& path) {
  const Json here = ToJson(DescribeContext(""))["build"]["bullet"],
             there = json.at("context").at("build").at("bullet");
  const auto expect = [&](bool holds, const std::string& what) {
    if (!holds) throw Failure(kUsage, fmt::format("--beside '{}': {}", path, what));
  };
  CheckLength(json, options, "--beside", path);
  expect(json.at("scale") == options.trial.world.scale, "its worlds have another --scale");
  expect(json.value("unit", 1.0) == options.trial.world.unit, "its worlds have another --unit");
  for (const bench::Condition& condition : bench::Conditions()) {
    expect(json.value(condition.name, false) == options.trial.world.*condition.on,
           fmt::format("only its worlds, or only these, are of --{}", condition.name));
  }
  expect(
      there.at("version") == here.at("version") && there.at("precision") == here.at("precision"),
      fmt::format("it is of Bullet {} {}, this is {} {}", there.at("version").get<std::string>(),
                  there.at("precision").get<std::string>(), here.at("version").get<std::string>(),
                  here.at("precision").get<std::string>()));
}

}  // namespace

bench::BulletRuns ReadBulletRuns(std::span<const std::string> files,
                                 const bench::CampaignOptions& options) {
  bench::BulletRuns runs;
  for (const std::string& path : files) {
    ReadResults("--beside", path, [&](const Json& json) {
      CheckContext(json, options, path);
      for (const Json& world : json.at("worlds")) {
        std::vector<bench::Trial> trials = BulletOf(TrialsOf(world));
        if (trials.empty()) continue;
        runs.insert_or_assign(world.at("seed").get<std::uint64_t>(), std::move(trials));
      }
    });
  }
  return runs;
}

EarlierRuns ReadEarlierRuns(const std::string& path, const bench::CampaignOptions& options) {
  EarlierRuns runs;
  ReadResults("--against", path, [&](const Json& json) {
    CheckLength(json, options, "--against", path);
    for (const Json& world : json.at("worlds")) {
      runs.insert_or_assign(world.at("seed").get<std::uint64_t>(), TrialsOf(world));
    }
  });
  return runs;
}

std::string WorldsToJson(const bench::CampaignOptions& options,
                         std::span<const bench::WorldResult> results, const std::string& command) {
  Json worlds = Json::array();
  for (const bench::WorldResult& result : results) worlds.push_back(ToJson(result, options));
  Json json = {{"context", ToJson(DescribeContext(command))}, {"seconds", options.trial.seconds},
               {"scale", options.trial.world.scale},          {"unit", options.trial.world.unit},
               {"audit_every", options.trial.audit_every},    {"worlds", worlds}};
  for (const bench::Condition& condition : bench::Conditions()) {
    json[condition.name] = options.trial.world.*condition.on;
  }
  return json.dump(1) + "\n";
}

}  // namespace cairn::cli
