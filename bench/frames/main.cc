// SPDX-License-Identifier: MIT
// Cairn in worlds of Bullet, timed part by part and beside Bullet.
#include <fmt/format.h>

#include <exception>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "frames/experiments.h"
#include "support/arguments.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/machine/setup.h"

namespace cairn::frames {
namespace {

std::vector<SceneChoice> ParseScenes(const std::vector<std::string>& words,
                                     const std::string& size = "") {
  std::vector<SceneChoice> scenes;
  for (const std::string& word : words) scenes.push_back(cli::ParseScene(word, size));
  return scenes;
}

void AddScenes(CLI::App* app, std::vector<std::string>* words) {
  app->add_option("--scene", *words,
                  "NAME, NAME:SIZE, NAME@FIRST_FRAME, random:SEED; may be repeated")
      ->capture_default_str();
}

void AddFrames(CLI::App* app, int* first, int* count) {
  app->add_option("--frame", *first, "First frame looked at")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  app->add_option("--frames", *count, "How many")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
}

void AddThreads(CLI::App* app, std::vector<int>* threads) {
  app->add_option("--threads", *threads, "So many; several with commas between them")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
}

void AddWork(CLI::App* app, Work* work) {
  app->add_flag(
      "--default", [work](std::int64_t) { *work = Work::kDefault; },
      "Default settings instead of ten plain sweeps: accelerated ones, and steps where they pay");
}

void AddDeadlines(CLI::App* app, DeadlineOptions* options) {
  app->add_option("--worlds", options->worlds, "Random worlds")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  app->add_option("--first-seed", options->first_seed, "Of the random worlds");
  app->add_option("--budget", options->budgets_ms, "[ms]; may be repeated")
      ->check(CLI::NonNegativeNumber);
  app->add_option("--warm-up", options->warm_up, "Frames of each world that do not count")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  app->add_option("--frames", options->frames, "Of a scene, after those")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app->add_option("--seconds", options->seconds, "Of a random world")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app->add_option("--worst", options->worst, "The latest substeps of each row, one by one")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  const std::map<std::string, BudgetClock> clocks = {{"wall", BudgetClock::kWall},
                                                     {"cpu", BudgetClock::kThreadCpu}};
  app->add_option("--clock", options->clock, "That budgets are measured with: wall or cpu")
      ->transform(CLI::CheckedTransformer(clocks));
  app->add_option("--min-sweeps", options->settings.tuning.min_sweeps, "Tuning::min_sweeps");
  app->add_option("--threads", options->settings.threads)->capture_default_str();
}

/// What was typed behind the options of `cairn_frames parts`.
struct PartsWords {
  WindowOptions options;
  std::vector<std::string> scenes = {"castle", "pyramid:100", "ragdolls:136", "islands"};
  std::string size;
  bool no_steps = false;
};

void AddParts(CLI::App* app, PartsWords* words) {
  AddScenes(app, &words->scenes);
  AddFrames(app, &words->options.frame, &words->options.frames);
  app->add_option("--size", words->size, "Of scenes that are named without one");
  app->add_flag("--no-steps", words->no_steps, "Sweeps alone");
}

int Main(int count, char** arguments) {
  CLI::App app("Parts, threads and budgets of Cairn in worlds of Bullet.", "cairn_frames");
  app.require_subcommand(1);

  ThreadOptions threads{.window = {.scenes = {}, .frame = 60, .frames = 60}};
  std::vector<std::string> thread_scenes = {"pyramid:100", "pyramid3d:30", "islands:2500",
                                            "pyramid3d:12", "rubble@240"};
  CLI::App* const threads_app =
      app.add_subcommand("threads", "Substeps on one thread, two, and so on");
  AddScenes(threads_app, &thread_scenes);
  AddFrames(threads_app, &threads.window.frame, &threads.window.frames);
  AddThreads(threads_app, &threads.threads);
  AddWork(threads_app, &threads.work);
  threads_app->add_flag("--parts", threads.parts,
                        "Also what threads are busy with; reads the clock at each unit of work");

  ThreadOptions scaling{.window = {.scenes = {}, .frame = 60, .frames = 20},
                        .threads = {1, 2, 4, 8, 16}};
  std::vector<std::string> scaling_scenes = thread_scenes;
  CLI::App* const scaling_app = app.add_subcommand(
      "scaling", "What substeps would take on more threads than there are cores");
  AddScenes(scaling_app, &scaling_scenes);
  AddFrames(scaling_app, &scaling.window.frame, &scaling.window.frames);
  AddThreads(scaling_app, &scaling.threads);
  AddWork(scaling_app, &scaling.work);
  scaling_app
      ->add_option("--gaps", scaling.gaps,
                   "Also the so many longest stretches in which one thread is alone, cut for the "
                   "last number of threads")
      ->check(CLI::Range(0, 100));

  ThreadOptions mt{.window = {.scenes = {}, .frame = 60, .frames = 60}};
  CLI::App* const mt_app =
      app.add_subcommand("mt", "Bullet's multithreaded world, with its solvers and with Cairn");
  AddFrames(mt_app, &mt.window.frame, &mt.window.frames);
  AddThreads(mt_app, &mt.threads);
  AddWork(mt_app, &mt.work);

  WindowOptions swap{.scenes = {}, .frame = 60, .frames = 40};
  std::vector<std::string> swap_scenes = {"pyramid:100", "castle",   "pyramid3d",    "wall",
                                          "rubble@240",  "ragdolls", "ragdolls:136", "islands",
                                          "bridge",      "chain",    "tower"};
  CLI::App* const swap_app =
      app.add_subcommand("swap", "The whole adapter against Bullet's solver");
  AddScenes(swap_app, &swap_scenes);
  AddFrames(swap_app, &swap.frame, &swap.frames);

  WindowOptions step;
  Work step_work = Work::kPlainSweeps;
  std::vector<std::string> step_scenes = swap_scenes;
  CLI::App* const step_app = app.add_subcommand("step", "Whole steps of a world");
  AddScenes(step_app, &step_scenes);
  AddFrames(step_app, &step.frame, &step.frames);
  AddWork(step_app, &step_work);

  PartsWords parts;
  CLI::App* const parts_app = app.add_subcommand("parts", "Where a substep goes");
  AddParts(parts_app, &parts);

  WindowOptions footprint;
  int functions = 0;
  std::vector<std::string> footprint_scenes = {"incline", "door", "tower", "slab"};
  CLI::App* const footprint_app =
      app.add_subcommand("footprint", "How much code a substep runs through");
  AddScenes(footprint_app, &footprint_scenes);
  footprint_app->add_option("--frame", footprint.frame, "The frame looked at")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  footprint_app
      ->add_option("--functions", functions,
                   "Also list so many functions, those of the most lines first")
      ->check(CLI::Range(0, 10000));

  DeadlineOptions deadlines;
  std::vector<std::string> deadline_scenes = {"castle", "islands", "rubble"};
  CLI::App* const deadlines_app =
      app.add_subcommand("deadlines", "How well Budget::Time is kept in worlds, with steps");
  AddScenes(deadlines_app, &deadline_scenes);
  AddDeadlines(deadlines_app, &deadlines);

  const cli::Arguments typed = {arguments + 1, arguments + count};
  if (!cli::Read(cli::SpellOut(app, typed), &app)) return cli::kFine;
  const std::string command = cli::WithoutPaths("cairn_frames", typed);
  cli::WarnOfTarget("cairn_frames");
  if (swap_app->parsed()) {
    swap.scenes = ParseScenes(swap_scenes);
    PrintSwaps(swap, command);
  } else if (parts_app->parsed()) {
    parts.options.scenes = ParseScenes(parts.scenes, parts.size);
    PrintParts(parts.options, parts.no_steps ? Steps::kNone : Steps::kWherePredicted, command);
  } else if (footprint_app->parsed()) {
    footprint.scenes = ParseScenes(footprint_scenes);
    PrintFootprints(footprint, functions, command);
  } else if (deadlines_app->parsed()) {
    deadlines.scenes = ParseScenes(deadline_scenes);
    PrintDeadlines(deadlines, command);
  } else if (mt_app->parsed()) {
    PrintMtWorlds(mt, command);
  } else if (scaling_app->parsed()) {
    scaling.window.scenes = ParseScenes(scaling_scenes);
    PrintScaling(scaling, command);
  } else if (step_app->parsed()) {
    step.scenes = ParseScenes(step_scenes);
    PrintSteps(step, step_work, command);
  } else {
    threads.window.scenes = ParseScenes(thread_scenes);
    PrintThreads(threads, command);
  }
  return 0;
}

}  // namespace

std::string NameOf(const SceneChoice& scene) {
  const bool usual = scene.size == scene.info->default_size;
  return usual ? std::string(scene.info->name) : fmt::format("{} {}", scene.info->name, scene.size);
}

Settings Sweeps(int count, int threads) {
  Settings settings;
  settings.method = Method::kPgs;
  settings.max_sweeps = count;
  settings.tolerance = 0;
  settings.tuning.min_progress = 0;
  settings.threads = threads;
  return settings;
}

Settings SettingsFor(Work work, int threads) {
  constexpr int kIterations = 10;
  if (work == Work::kPlainSweeps) return Sweeps(kIterations, threads);
  return {.threads = threads};
}

std::string Describe(Work work) {
  return work == Work::kPlainSweeps ? "ten plain sweeps" : "ten iterations with default settings";
}

}  // namespace cairn::frames

int main(int count, char** arguments) {
  try {
    return cairn::frames::Main(count, arguments);
  } catch (const cairn::cli::Failure& failure) {
    fmt::print(stderr, "cairn_frames: {}\n", failure.what());
    return failure.code();
  } catch (const std::exception& error) {
    fmt::print(stderr, "cairn_frames: {}\n", error.what());
    return cairn::cli::kUsage;
  }
}
