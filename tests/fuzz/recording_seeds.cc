// SPDX-License-Identifier: MIT
// Recordings to begin with: cairn_recording_seeds FOLDER
#include <cstdio>
#include <filesystem>
#include <string>

#include "tests/core/support/recording_problems.h"

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: cairn_recording_seeds FOLDER\n");
    return 2;
  }
  const std::string folder = arguments[1];
  std::filesystem::create_directories(folder);
  const auto save = [&folder](const cairn::Recording& recording, const std::string& name) {
    const cairn::RecordingStatus status = cairn::Save(recording, folder + "/" + name);
    if (!status.ok()) std::fprintf(stderr, "%s\n", status.message.c_str());
    return status.ok();
  };
  bool fine = save({}, "empty.cairn");
  constexpr int kSeeds = 32;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const std::string name = "random-" + std::to_string(seed) + ".cairn";
    fine = save(cairn::test::RandomRecording(seed), name) && fine;
  }
  return fine ? 0 : 1;
}
