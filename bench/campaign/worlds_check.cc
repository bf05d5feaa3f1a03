// SPDX-License-Identifier: MIT
#include "campaign/campaign_output.h"

#include <fmt/format.h>

#include <filesystem>

#include "support/machine/setup.h"
#include "support/output_file.h"
#include "worlds/shrink.h"

namespace cairn::cli {
namespace {

std::string ShrinkOne(const bench::CampaignOptions& options, const bench::WorldResult& result,
                      size_t variant, const std::string& folder) {
  const bench::Variant& solver = options.variants[variant];
  const bench::Shrunk shrunk = bench::Shrink(options, result, variant);
  const std::string stem = fmt::format("seed-{}-{}", result.seed, solver.name);
  const std::string path = (std::filesystem::path(folder) / stem).string();
  const bool recorded = bench::RecordWorstFrame(shrunk, solver, path + ".cairn");
  const std::string line = fmt::format(
      "{}: {} {:.3g} > {:.3g}; {} bodies, {} joints, {:.3g} s, worst frame {}{}\n", stem,
      NameOf(shrunk.finding.oracle), shrunk.finding.value, shrunk.finding.line, shrunk.trial.bodies,
      shrunk.trial.joints, shrunk.seconds, shrunk.worst_frame, recorded ? "" : " (not recorded)");
  WriteFile(
      path + ".txt",
      fmt::format("{}{}\ncairn worlds --seed {} --scale {} --seconds {} --solver {}{} --report\n",
                  line, DescribeWorld(shrunk.world), result.seed, shrunk.world.scale,
                  shrunk.seconds, solver.name, bench::OptionsOf(shrunk.world)));
  return line;
}

}  // namespace

void CheckBits(const bench::CampaignOptions& options, std::vector<bench::WorldResult>* results) {
  bench::CampaignOptions again = options;
  for (const simd::Target other : simd::SupportedTargets()) {
    const ForcedTarget forced(other);
    bench::CompareBits(again, results);
  }
  for (const int threads : {2, 3}) {
    again.trial.threads = threads;
    bench::CompareBits(again, results);
  }
}

std::string ShrinkFailures(const bench::CampaignOptions& options,
                           const std::vector<bench::WorldResult>& results,
                           const std::string& folder) {
  CheckFolder(folder);
  std::string text;
  for (const bench::WorldResult& result : results) {
    for (size_t i = 0; i < options.variants.size(); ++i) {
      if (!result.findings[i].empty()) text += ShrinkOne(options, result, i, folder);
    }
  }
  return text;
}

std::string DescribeWorld(const bench::WorldSeed& seed) {
  btSequentialImpulseConstraintSolver solver;
  return bench::RandomWorld(seed, &solver).Describe();
}

}  // namespace cairn::cli
