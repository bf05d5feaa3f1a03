// SPDX-License-Identifier: MIT
#include "accuracy/report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/json_number.h"
#include "support/output_file.h"

namespace cairn::accuracy {

void PrintContext(const std::string& title, const cli::RunContext& context) {
  fmt::print("# {}\n\n", title);
  fmt::print("- machine: {}, {} cores, load {}; {}\n", context.machine.cpu, context.machine.cores,
             context.machine.load_average, context.noise.verdict);
  fmt::print("- build: Cairn {}, {}, {}, kernels for {}; {}\n", context.build.version,
             context.build.build_type, context.build.compiler, context.simd_target,
             cli::DescribeBullet(context.build));
  fmt::print("- command: `{}`\n", context.command);
#if !defined(__OPTIMIZE__) || !defined(NDEBUG)
  fmt::print("- WARNING: not an optimised build, what is timed means nothing\n");
#endif
}

nlohmann::ordered_json JsonHead(const std::string& subcommand, const cli::RunContext& context) {
  return {{"schema_version", 1}, {"subcommand", subcommand}, {"context", cli::ToJson(context)}};
}

void WriteJson(const std::string& path, const nlohmann::ordered_json& json) {
  if (!path.empty()) cli::WriteFile(path, json.dump(1) + "\n");
}

nlohmann::ordered_json ToJson(const bench::VelocityDistance& distance) {
  return {{"rms_m_s", cli::Number(distance.rms)}, {"max_m_s", cli::Number(distance.max)}};
}

std::string Digits(double value) { return std::isnan(value) ? "-" : fmt::format("{:.3g}", value); }

}  // namespace cairn::accuracy
