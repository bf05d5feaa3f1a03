// SPDX-License-Identifier: MIT
#include "cli/run_context.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "cli/json_number.h"
#include "simd/target.h"

namespace cairn::cli {
namespace {

using Json = nlohmann::ordered_json;

Json ToJson(const BuildInfo& build) {
  return {{"cairn", build.version},
          {"compiler", build.compiler},
          {"build_type", build.build_type},
          {"bullet",
           {{"version", build.bullet_version},
            {"precision", build.bullet_precision},
            {"rows", build.bullet_rows},
            {"threads", build.bullet_threads},
            {"library", build.bullet_library}}}};
}

}  // namespace

RunContext DescribeContext(const std::string& command) {
  return {.date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))),
          .command = command,
          .build = DescribeBuild(),
          .machine = DescribeMachine(),
          .noise = MeasureNoise(std::chrono::milliseconds(300)),
          .simd_target = std::string(simd::TargetName(simd::ChooseTarget().target))};
}

Json ToJson(const RunContext& context) {
  return {{"date", context.date},
          {"command", context.command},
          {"host",
           {{"cpu", context.machine.cpu},
            {"cores", context.machine.cores},
            {"governor", context.machine.governor},
            {"load_average", context.machine.load_average},
            {"simd_target", context.simd_target}}},
          {"build", ToJson(context.build)},
          {"noise",
           {{"median_ms", Number(context.noise.median)},
            {"p99_over_median", Number(context.noise.p99_over_median)},
            {"threshold_percent", Number(context.noise.threshold)},
            {"verdict", context.noise.verdict}}}};
}

}  // namespace cairn::cli
