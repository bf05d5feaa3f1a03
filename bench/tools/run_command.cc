// SPDX-License-Identifier: MIT
#include "tools/run_command.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "CLI/CLI.hpp"
#include "compare/noise_table.h"
#include "page/html_report.h"
#include "run/imported_scene.h"
#include "run/output/csv_output.h"
#include "run/output/json_output.h"
#include "run/output/run_tables.h"
#include "run/output/trace_file.h"
#include "run/run.h"
#include "support/command_line.h"
#include "support/duration.h"
#include "support/failure.h"
#include "support/output_file.h"
#include "tools/small_command.h"

namespace cairn::cli {
namespace {

/// What was typed behind the options of `cairn run`.
struct RunWords {
  std::vector<std::string> scenes, imports;
  std::string solvers = "bullet-si,bullet-nncg,bullet-dantzig,cairn";
  std::string budget, iterations, frames = "300", size, seed = "0", samples = "8";
  std::string threads = "1", simd, pin, repeat = "1", warmup = "0";
  bool noise = false;
  std::string json, csv, markdown, report, trace, trace_frame;
  OutputWords output;
};

constexpr const char* kRunNotes =
    R"(Time and iterations:
  --budget B                 Cairn stops at the clock after B of solver time. Bullet's solvers have
                             no clock: they make Bullet's default of 10 iterations, and frames that
                             took longer than B are counted ("over budget").
  --budget 100000units       Cairn stops after so much work, counted: the same results each time.
                             A unit is one relaxation of a row
  --budget B --iterations N  the same with N iterations for Bullet's solvers
  --budget B --iterations fit
                             the iterations of Bullet's solvers are adapted from frame to frame to
                             fit B (at least 1), which is what users do by hand
  --iterations N             all make N iterations, Cairn without a clock: the same results each time
A solver may have iterations of its own: bullet-si@50, bullet-si@fit, cairn@10 (without a clock).

Solvers that fail are shown as FAILED, with frame and reason.
Exit codes: 0 fine, 1 a solver of Cairn failed, 2 usage, 3 a file or program cannot be used.)";

RunOptions Check(const RunWords& words) {
  RunOptions options;
  options.seed = ParseCount("--seed", words.seed, 0, 1'000'000'000,
                            "0: the scene as designed, else displaced by up to 0.1 mm");
  options.scenes = ParseScenes(words.scenes, words.size, options.seed);
  for (const std::string& path : words.imports) {
    options.scenes.push_back(ImportScene(path, options.seed));
  }
  if (options.scenes.empty()) {
    throw Failure(kUsage,
                  "run needs a scene ('cairn list scenes' shows all), or a world that "
                  "Bullet saved: --import FILE");
  }
  options.solvers = ParseSolvers(words.solvers);
  if (!words.budget.empty()) {
    const FrameBudget budget = ParseBudget("--budget", words.budget);
    options.budget = budget.time;
    options.units = budget.units;
  }
  if (!words.iterations.empty()) {
    options.iterations = ParseIterations("--iterations", words.iterations);
  }
  options.frames = static_cast<int>(
      ParseCount("--frames", words.frames, 1, 1'000'000, "frames of 1/60 s to simulate"));
  options.warmup = static_cast<int>(ParseCount("--warmup", words.warmup, 0, options.frames - 1,
                                               "the first frames, which do not count"));
  options.repeat = static_cast<int>(
      ParseCount("--repeat", words.repeat, 1, 1000, "times that everything is run"));
  options.noise = words.noise;
  options.setup = ParseSetup(words.threads, words.simd, words.pin);
  for (SolverChoice& solver : options.solvers) solver.threads = options.setup.threads;
  options.samples = static_cast<int>(ParseCount("--samples", words.samples, 0, 1000,
                                                "frames at which the velocity error is measured"));
  options.progress = ParseProgress(words.output);
  options.page = !words.report.empty();
  options.timelines = options.page || !words.trace.empty();
  if (!words.trace_frame.empty()) {
    if (words.trace.empty()) throw Failure(kUsage, "--trace-frame needs --trace FILE");
    options.trace_frame = static_cast<int>(ParseCount("--trace-frame", words.trace_frame, 0,
                                                      options.frames - 1, "a frame of the run"));
  }

  const auto is_fit = [](const IterationRule& rule) {
    return rule.kind == IterationRule::Kind::kFit;
  };
  bool fit = is_fit(options.iterations);
  for (const SolverChoice& solver : options.solvers) {
    fit = fit || (solver.own_iterations && is_fit(*solver.own_iterations));
  }
  if (fit && !options.budget) {
    throw Failure(kUsage,
                  "iterations can only be made to fit a budget of time: add --budget 2ms, say");
  }
  return options;
}

int DoRun(const RunWords& words, const std::string& command) {
  const RunOptions options = Check(words);
  Apply(options.setup);
  const std::pair<std::string, std::string (*)(const RunResult&)> files[] = {
      {words.json, &ToJson},
      {words.csv, &ToCsv},
      {words.markdown, &ToMarkdown},
      {words.report, &ToHtml},
      {words.trace, &ToTrace}};
  for (const auto& [path, format] : files) {
    if (!path.empty()) CheckWritable(path);
  }
  const RunResult result = Run(options, command);
  fmt::print("{}", ToText(result));
  if (options.noise) fmt::print("{}\n", NoiseText(result));
  if (!words.output.quiet) fmt::print("{}", ReadingHelp(result));
  for (const auto& [path, format] : files) {
    if (!path.empty()) WriteFile(path, format(result));
  }
  return result.check_failed() ? kCheckFailed : kFine;
}

}  // namespace

Command AddRunCommand(CLI::App* app) {
  const auto words = std::make_shared<RunWords>();
  CLI::App* const run = app->add_subcommand(
      "run",
      "Simulate scenes with several solvers and measure time, error and what became of them");
  run->footer(kRunNotes);
  run->add_option("scene", words->scenes, "Scenes to run; 'all' for every one")
      ->type_name("SCENE...");
  run->add_option("--import", words->imports,
                  "A world that Bullet saved (.bullet; saveBullet() of PyBullet), as a scene")
      ->type_name("FILE")
      ->allow_extra_args(false);
  const auto add = [run](const char* name, std::string* word, const char* help, const char* type) {
    AddText(run, name, word, help, type);
  };
  run->add_option("--solver", words->solvers, "Solvers, with commas between them")
      ->type_name("A,B,...")
      ->take_last()
      ->capture_default_str();
  add("--budget", &words->budget,
      "Solver time for a frame, such as 2ms, 500us, 0.002s; or work, such as 100000units", "B");
  add("--iterations", &words->iterations, "Iterations of solvers, or fit (below); default 10", "N");
  add("--frames", &words->frames, "Frames of 1/60 s; default 300", "N");
  add("--size", &words->size, "Size of the scene; see cairn list scenes", "N");
  add("--seed", &words->seed,
      "Displaces bodies by up to 0.1 mm, differently for each seed; default 0: none", "N");
  add("--samples", &words->samples,
      "Frames at which the velocity error is measured, at most a quarter of all; default 8", "N");
  add("--warmup", &words->warmup,
      "Frames, the first ones, that are run and do not count; default 0", "N");
  add("--repeat", &words->repeat,
      "Runs everything N times: times are of all, the rest is of the first; default 1", "N");
  add("--threads", &words->threads, "Threads that Cairn may use; default 1", "N");
  add("--simd", &words->simd, "SIMD target of Cairn instead of the best; see cairn doctor",
      "TARGET");
  add("--pin", &words->pin, "Stays on this core, counted from 0", "CORE");
  run->add_flag("--noise", words->noise, "Shows how noisy the machine was during the run");
  add("--json", &words->json, "Write everything that was measured", "FILE");
  add("--csv", &words->csv, "Write a line for each scene, solver and frame", "FILE");
  add("--markdown", &words->markdown, "Write the tables as Markdown", "FILE");
  add("--report", &words->report, "Write a page with pictures (HTML, needs no network)", "FILE");
  add("--trace", &words->trace,
      "Write what each thread did in the slowest frame, for ui.perfetto.dev (JSON)", "FILE");
  add("--trace-frame", &words->trace_frame, "The frame for --trace instead of the slowest", "N");
  AddOutputWords(run, &words->output);
  return {run,
          [words](const std::string& typed) { return DoRun(*words, typed); },
          {AddSmallCommand(run)}};
}

}  // namespace cairn::cli
