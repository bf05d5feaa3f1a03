// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "run/options.h"
#include "support/command.h"
#include "support/machine/setup.h"

namespace CLI {
class Option;
}

namespace cairn::cli {

// Options that several commands have: what was typed behind them, as it stands before it is
// checked.

/// Which scenes: SCENE..., --size, --seed, --directions.
struct SceneWords {
  std::vector<std::string> scenes;
  std::string size, seed = "0", directions = "2";
};
/// @param what  is done to the scenes: "run"
CLI::Option* AddScenes(CLI::App* app, const char* what, SceneWords* words);
/// Adds --size, --seed and --directions.
void AddSceneOptions(CLI::App* app, SceneWords* words);
/// --directions alone.
void AddDirections(CLI::App* app, std::string* directions);
/// @throws Failure (kUsage)
void TakeDirections(const std::string& directions, std::vector<SceneChoice>* scenes);

/// What a frame may cost: --budget, --iterations.
struct EffortWords {
  std::string budget, iterations;
};

/// Seed, scenes, budget and iterations. @throws Failure (kUsage)
void Parse(const SceneWords& scenes, const EffortWords& effort, RunOptions* options);

/// Iterations of some solver are fitted to a budget.
bool AnyFit(const RunOptions& options);

/// How the machine is used: --threads, --simd, --pin.
struct SetupWords {
  std::string threads = "1", simd, pin;
};
void AddSetup(CLI::App* app, SetupWords* words);
Setup Parse(const SetupWords& words);

}  // namespace cairn::cli
