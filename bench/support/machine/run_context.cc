// SPDX-License-Identifier: MIT
#include "support/machine/run_context.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>

#include "simd/target.h"
#include "support/json_number.h"
#include "support/names.h"

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

Json ToJson(const std::vector<Cache>& caches) {
  Json list = Json::array();
  for (const Cache& cache : caches) {
    list.push_back({{"type", cache.type},
                    {"level", cache.level},
                    {"size", cache.bytes},
                    {"num_sharing", cache.cores}});
  }
  return list;
}

Json LoadAverages(const std::string& text) {
  Json list = Json::array();
  for (const std::string& word : Split(text, ' ')) list.push_back(std::atof(word.c_str()));
  return list;
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
  const Machine& machine = context.machine;
  return {{"date", context.date},
          {"command", context.command},
          {"executable", program_invocation_short_name},
          {"num_cpus", machine.cores},
          {"mhz_per_cpu", machine.megahertz == 0 ? Json(nullptr) : Json(machine.megahertz)},
          {"cpu_scaling_enabled",
           machine.governor.empty() ? Json(nullptr) : Json(machine.governor != "performance")},
          {"caches", ToJson(machine.caches)},
          {"load_avg", LoadAverages(machine.load_average)},
          {"library_build_type", context.build.build_type},
          {"host",
           {{"cpu", machine.cpu},
            {"cores", machine.cores},
            {"governor", machine.governor},
            {"load_average", machine.load_average},
            {"simd_target", context.simd_target}}},
          {"build", ToJson(context.build)},
          {"noise",
           {{"median_ms", Number(context.noise.median)},
            {"p99_over_median", Number(context.noise.p99_over_median)},
            {"threshold_percent", Number(context.noise.threshold)},
            {"verdict", context.noise.verdict}}}};
}

std::string Origin(const std::string& title, const RunContext& context) {
  std::string text = fmt::format(
      "# {}\n\n- machine: {}, {} cores, load {}; {}\n"
      "- build: Cairn {}, {}, {}, kernels for {}; {}\n- command: `{}`\n",
      title, context.machine.cpu, context.machine.cores, context.machine.load_average,
      context.noise.verdict, context.build.version, context.build.build_type,
      context.build.compiler, context.simd_target, DescribeBullet(context.build), context.command);
#if !defined(__OPTIMIZE__) || !defined(NDEBUG)
  text += "- WARNING: not an optimised build, what is timed means nothing\n";
#endif
  return text;
}

}  // namespace cairn::cli
