// SPDX-License-Identifier: MIT
// cairn-play: what `cairn play` starts.
#include <fmt/format.h>

#include "CLI/CLI.hpp"
#include "contestants/solver_registry.h"
#include "play/view/app.h"
#include "support/arguments.h"
#include "support/command.h"
#include "support/command_line.h"
#include "support/duration.h"
#include "support/failure.h"
#include "support/machine/setup.h"
#include "tools/solver_names.h"

namespace cairn::play {
namespace {

using cli::Failure;
using cli::kUsage;

struct Words {
  std::string scene = "castle", size, seed = "0", solver = "bullet-si,cairn", budget, iterations,
              frames, window = "1440x810";
};

constexpr const char* kNotes =
    R"(Left mouse: drag a body, or turn; right: turn; middle: move; wheel: nearer. Keys: space pause,
N step, R restart, B shoot, S save a frame, V view, P panels. Without a screen: xvfb-run -a cairn play ...
docs/play.md has the commands of --commands.)";

void SetSolvers(const Words& words, Controls* controls) {
  const std::vector<cli::SolverChoice> choices =
      cli::ParseSolvers(cli::OwnSolverNames(cli::SolverUser::kRun, words.solver));
  if (choices.size() > 2) throw Failure(kUsage, "--solver: two worlds at most");
  controls->worlds = static_cast<int>(choices.size());
  for (size_t i = 0; i < choices.size(); ++i) {
    PlayerControls& player = controls->players[i];
    player = {.solver = choices[i].entry->name};
    const cli::IterationRule rule = choices[i].own_iterations.value_or(
        words.iterations.empty() ? cli::IterationRule{}
                                 : cli::ParseIterations("--iterations", words.iterations));
    if (rule.kind == cli::IterationRule::Kind::kFit) {
      throw Failure(kUsage, "iterations that fit a budget are for cairn run");
    }
    player.iterations = rule.count;
    if (words.budget.empty() || choices[i].own_iterations) continue;
    player.budget = kFixed;
    player.budget_ms = cli::Milliseconds(cli::ParseDuration("--budget", words.budget));
  }
}

AppOptions Check(const Words& words, AppOptions options) {
  Controls& controls = options.controls;
  controls.scene.scene = words.scene;
  if (!words.size.empty()) {
    controls.scene.size = cli::ParseInt("--size", words.size, 1, 100'000, "size of the scene");
  }
  controls.scene.seed = cli::ParseInt("--seed", words.seed, 0, 1'000'000'000, "number of a seed");
  SetSolvers(words, &controls);
  if (!words.frames.empty()) {
    options.frames = cli::ParseInt("--frames", words.frames, 1, 1'000'000, "pictures");
  }
  const size_t cross = words.window.find('x');
  if (cross == std::string::npos) throw Failure(kUsage, "--window: write WIDTHxHEIGHT");
  const auto side = [](const std::string& text) {
    return cli::ParseInt("--window", text, 100, 8192, "pixels");
  };
  options.width = side(words.window.substr(0, cross));
  options.height = side(words.window.substr(cross + 1));
  return options;
}

int Main(int count, char** arguments) {
  CLI::App app("Worlds side by side in a window: Bullet and Cairn, live.", "cairn play");
  app.footer(kNotes);
  Words words;
  AppOptions options;
  app.add_option(
      "scene", words.scene,
      "A scene of 'cairn list scenes', 'random', or a file *.bullet or *.cairn; default castle");
  const auto add = cli::TextAdder(&app);
  add("--size", &words.size, "Size of the scene", "N");
  add("--seed", &words.seed, "Number of a random world, or of small displacements", "N");
  add("--solver", &words.solver, "One or two; default bullet-si,cairn", "A,B");
  add("--budget", &words.budget, "Time of a step for solvers with a clock: 2ms", "B");
  add("--iterations", &words.iterations, "Of solvers that count; default 10", "N");
  add("--frames", &words.frames, "Ends after so many pictures, one step in each", "N");
  add("--screenshot", &options.screenshot, "Writes the last picture", "FILE.png");
  add("--video", &options.video, "Writes all pictures, numbered", "DIR");
  add("--commands", &options.commands, "Does what the file says, a command a line", "FILE");
  add("--window", &words.window, "Size of the window; default 1440x810", "WxH");
  if (!cli::Read({arguments + 1, arguments + count}, &app)) return cli::kFine;
  const AppOptions checked = Check(words, options);
  cli::WarnOfTarget("cairn play");
  App(checked).Run();
  return cli::kFine;
}

}  // namespace
}  // namespace cairn::play

int main(int count, char** arguments) {
  try {
    return cairn::play::Main(count, arguments);
  } catch (const cairn::cli::Failure& failure) {
    fmt::print(stderr, "cairn play: {}\n", failure.what());
    return failure.code();
  } catch (const std::exception& error) {
    fmt::print(stderr, "cairn play: {}\n", error.what());
    return cairn::cli::kBadInput;
  }
}
