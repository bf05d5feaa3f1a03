// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "run/scene_choice.h"
#include "support/command.h"
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

}  // namespace cairn::accuracy
