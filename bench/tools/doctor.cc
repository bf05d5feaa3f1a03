// SPDX-License-Identifier: MIT
#include "tools/commands.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <vector>

#include "simd/target.h"
#include "support/machine/build_info.h"
#include "support/machine/machine.h"
#include "support/output_file.h"
#include "tools/precision.h"

namespace cairn::cli {
namespace {

struct Finding {
  std::string name, text;
};

std::string SupportedTargets() {
  std::vector<std::string_view> names;
  for (simd::Target target : simd::SupportedTargets()) names.push_back(simd::TargetName(target));
  return fmt::format("{}", fmt::join(names, " "));
}

std::string ChosenTarget() {
  using Reason = simd::TargetChoice::Reason;
  const simd::TargetChoice choice = simd::ChooseTarget();
  const std::string_view name = simd::TargetName(choice.target);
  switch (choice.reason) {
    case Reason::kAsked:
      return fmt::format("{}, asked for by CAIRN_SIMD", name);
    case Reason::kUnknown:
      return fmt::format("{}; CAIRN_SIMD='{}' is no target, this CPU has: {}", name, choice.asked,
                         SupportedTargets());
    case Reason::kUnsupported:
      return fmt::format("{}; CAIRN_SIMD='{}' does not run on this CPU, which has: {}", name,
                         choice.asked, SupportedTargets());
    case Reason::kBest:
      break;
  }
  return fmt::format("{}, the best of this CPU (CAIRN_SIMD chooses another)", name);
}

std::string OtherBullet() {
  const std::string other = OwnPrecision() == "float" ? "float64" : "float";
  const auto sibling = FindSibling(other);
  const std::string line = sibling ? FirstLineOf(*sibling, "doctor --bullet") : "";
  return line.empty() ? fmt::format("{}: not built", other) : line;
}

std::vector<Finding> Examine() {
  const Machine machine = DescribeMachine();
  const BuildInfo build = DescribeBuild();
  const Noise noise = MeasureNoise(std::chrono::seconds(1));
  return {
      {"CPU", machine.cpu.empty() ? "unknown" : machine.cpu},
      {"cores", fmt::format("{}", machine.cores)},
      {"SIMD targets", SupportedTargets()},
      {"SIMD in force", ChosenTarget()},
      {"governor", machine.governor.empty() ? "not readable" : machine.governor},
      {"load average", machine.load_average},
      {"cairn", fmt::format("{}, {}, {} build", build.version, build.compiler, build.build_type)},
      {"Bullet here", DescribeBullet(build)},
      {"Bullet beside", OtherBullet()},
      {"noise", fmt::format("{:.2f} ms of work repeated {} times: p99 is {:.2f} of the median",
                            noise.median, noise.repetitions, noise.p99_over_median)},
      {"verdict", noise.verdict},
  };
}

}  // namespace

void Doctor(const std::string& json_path) {
  if (!json_path.empty()) CheckWritable(json_path);
  nlohmann::ordered_json json = {{"schema_version", 1}};
  for (const Finding& finding : Examine()) {
    fmt::print("{:<14} {}\n", finding.name, finding.text);
    json[finding.name] = finding.text;
  }
  if (!json_path.empty()) WriteFile(json_path, json.dump(1) + "\n");
}

void DoctorBullet() { fmt::print("{}\n", DescribeBullet(DescribeBuild())); }

}  // namespace cairn::cli
