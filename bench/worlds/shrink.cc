// SPDX-License-Identifier: MIT
#include "worlds/shrink.h"

#include <algorithm>
#include <filesystem>
#include <optional>

namespace cairn::bench {
namespace {

constexpr double kScales[] = {0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
constexpr double kLeastSeconds = 0.05;

std::optional<Finding> FindingOf(const WorldResult& result, Oracle oracle) {
  for (const Finding& finding : result.findings.front()) {
    if (finding.oracle == oracle) return finding;
  }
  return std::nullopt;
}

/// Tries a world, and takes it if it fails by the same oracle.
bool Try(CampaignOptions options, const WorldSeed& world, double seconds, Shrunk* shrunk) {
  options.trial.seconds = seconds;
  const WorldResult result = RunWorld(options, world);
  const std::optional<Finding> finding = FindingOf(result, shrunk->finding.oracle);
  if (!finding) return false;
  shrunk->world = world;
  shrunk->seconds = seconds;
  shrunk->finding = *finding;
  shrunk->trial = result.trials.front();
  return true;
}

}  // namespace

Shrunk Shrink(const CampaignOptions& options, const WorldResult& result, size_t variant) {
  CampaignOptions own = options;
  own.variants = {options.variants[variant]};
  own.trial.audit_every = 1;
  Shrunk shrunk;
  shrunk.finding = result.findings[variant].front();
  shrunk.trial = result.trials[variant];
  shrunk.world = options.trial.world;
  shrunk.world.seed = result.seed;
  shrunk.seconds = options.trial.seconds;
  for (const double scale : kScales) {
    WorldSeed world = shrunk.world;
    world.scale = scale;
    if (scale < shrunk.world.scale && Try(own, world, shrunk.seconds, &shrunk)) break;
  }
  for (const double share : {0.25, 0.5, 0.8}) {
    while (shrunk.seconds * share > kLeastSeconds &&
           Try(own, shrunk.world, share * shrunk.seconds, &shrunk)) {
    }
  }
  // Of what is left, with every substep audited.
  own.trial.seconds = shrunk.seconds;
  own.trial.world = shrunk.world;
  shrunk.trial = RunTrial(own.trial, own.variants.front());
  const Trial& trial = shrunk.trial;
  shrunk.worst_frame = trial.audits_violated > 0 ? trial.worst_frame
                       : trial.wild_frame >= 0   ? trial.wild_frame
                                                 : trial.frames - 1;
  return shrunk;
}

bool RecordWorstFrame(const Shrunk& shrunk, const Variant& variant, const std::string& path) {
  TrialOptions options;
  options.world = shrunk.world;
  options.seconds = shrunk.seconds;
  options.audit_every = 0;
  options.record_path = path;
  options.record_frame = shrunk.worst_frame;
  RunTrial(options, variant);
  return std::filesystem::exists(path);
}

}  // namespace cairn::bench
