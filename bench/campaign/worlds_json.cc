// SPDX-License-Identifier: MIT
#include "campaign/campaign_output.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

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

}  // namespace

std::string WorldsToJson(const bench::CampaignOptions& options,
                         std::span<const bench::WorldResult> results, const std::string& command) {
  Json worlds = Json::array();
  for (const bench::WorldResult& result : results) worlds.push_back(ToJson(result, options));
  const Json json = {{"context", ToJson(DescribeContext(command))},
                     {"seconds", options.trial.seconds},
                     {"scale", options.trial.world.scale},
                     {"audit_every", options.trial.audit_every},
                     {"worlds", worlds}};
  return json.dump(1) + "\n";
}

}  // namespace cairn::cli
