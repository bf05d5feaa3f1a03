// SPDX-License-Identifier: MIT
#include "accuracy/command.h"

#include "support/names.h"

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

}  // namespace cairn::accuracy
