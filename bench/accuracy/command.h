// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "measure/velocity_norm.h"
#include "run/scene_choice.h"
#include "support/command.h"
#include "support/machine/run_context.h"
#include "support/progress.h"

namespace cairn::accuracy {

/// What all subcommands are asked.
struct Common {
  std::string scenes = "all", json;
  int frames = 0;
  cli::OutputWords words;

  /// @throws cli::Failure for a scene that there is not.
  std::vector<cli::SceneChoice> Scenes(std::uint64_t seed) const;
};

/// Adds --json, --frames and how progress is shown. @param what_frames  what --frames counts
void AddCommon(CLI::App* app, Common* common, const char* what_frames);
void AddScenes(CLI::App* app, Common* common);
/// Adds a number of at least `least`.
void AddCount(CLI::App* app, const char* name, int* count, int least, const char* help);

cli::Command AddStatesCommand(CLI::App* app);
cli::Command AddLoopCommand(CLI::App* app);
cli::Command AddGridCommand(CLI::App* app);
cli::Command AddTensionCommand(CLI::App* app);
cli::Command AddStandCommand(CLI::App* app);

/// Of a file: who wrote it, in which form, and under which circumstances.
nlohmann::ordered_json JsonHead(const std::string& subcommand, const cli::RunContext& context);

/// Does nothing without a path. @throws cli::Failure
void WriteJson(const std::string& path, const nlohmann::ordered_json& json);

/// {"rms_m_s": ..., "max_m_s": ...}
nlohmann::ordered_json ToJson(const bench::VelocityDistance& distance);

/// Three digits: "0.00123", "-" for what was not measured.
std::string Digits(double value);

}  // namespace cairn::accuracy
