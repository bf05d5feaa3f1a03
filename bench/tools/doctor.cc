// SPDX-License-Identifier: MIT
#include "tools/commands.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "simd/target.h"
#include "support/failure.h"
#include "support/machine/build_info.h"
#include "support/machine/machine.h"
#include "support/machine/setup.h"
#include "support/output_file.h"
#include "tools/precision.h"
#include "verify/world_answers.h"

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
    case Reason::kUnsupported:
      return fmt::format("{}; {}", name, WhyNotTarget());
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

namespace {

/// Says whether answers are the golden ones, and if not, where not.
bool Verify(std::string_view what, std::span<const verify::Answer> golden,
            std::span<const verify::Answer> now) {
  const std::vector<verify::Difference> differences = verify::Compare(golden, now);
  if (differences.empty()) {
    fmt::print("{:<14} {} of {} equal\n", what, now.size(), now.size());
    return true;
  }
  fmt::print("{:<14} {} differences\n", what, differences.size());
  for (const verify::Difference& difference : differences) {
    fmt::print("  {}\n", verify::Describe(difference));
  }
  return false;
}

bool VerifyWorlds() {
  return Verify("Bullet, " + OwnPrecision(), verify::GoldenWorldAnswers(), verify::WorldAnswers());
}

/// True if it is not there.
bool VerifySibling() {
  const std::string other = OwnPrecision() == "float" ? "float64" : "float";
  const auto sibling = FindSibling(other);
  if (!sibling) return true;
  const std::string line = FirstLineOf(*sibling, "doctor --verify-worlds");
  const std::string advice = OwnPrecision() == "float" ? "cairn --float64 doctor --verify"
                                                       : "cairn --precision float doctor --verify";
  fmt::print("{}\n",
             line.empty() ? fmt::format("Bullet, {}: differs; see {}", other, advice) : line);
  return !line.empty();
}

}  // namespace

int DoctorVerify() {
  WarnOfTarget();
  const bool core = Verify("core", verify::GoldenCoreAnswers(), verify::CoreAnswers());
  const bool worlds = VerifyWorlds(), sibling = VerifySibling();
  if (core && worlds && sibling) {
    fmt::print("verdict        this machine gives the golden answers, to the bit\n");
    return kFine;
  }
  fmt::print("verdict        {}\n",
             core ? "Cairn gives the golden answers; worlds differ by Bullet, or by the C library "
                    "that it takes sines of"
                  : "Cairn itself gives other answers here: please report this machine");
  return kCheckFailed;
}

int DoctorVerifyWorlds() { return VerifyWorlds() ? kFine : kCheckFailed; }

void DoctorBullet() { fmt::print("{}\n", DescribeBullet(DescribeBuild())); }

}  // namespace cairn::cli
