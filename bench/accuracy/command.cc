// SPDX-License-Identifier: MIT
#include "accuracy/command.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/json_number.h"
#include "support/names.h"
#include "support/output_file.h"

namespace cairn::accuracy {

std::vector<cli::SceneChoice> Common::Scenes(std::uint64_t seed) const {
  return cli::ParseScenes(cli::Split(scenes, ','), "", seed);
}

void AddCommon(CLI::App* app, Common* common, const char* what_frames) {
  AddCount(app, "--frames", &common->frames, 4, what_frames);
  cli::AddText(app, "--json", &common->json, "Write all figures to this file", "FILE");
  cli::AddText(app, "--progress", &common->words.progress,
               "Progress on stderr: auto (if a terminal), always, never", "WHEN");
}

void AddScenes(CLI::App* app, Common* common) {
  cli::AddText(app, "--scenes", &common->scenes, "Names with commas between them, or all", "NAMES");
}

void AddCount(CLI::App* app, const char* name, int* count, int least, const char* help) {
  app->add_option(name, *count, help)->check(CLI::Range(least, 1000000))->capture_default_str();
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
