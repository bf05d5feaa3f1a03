// SPDX-License-Identifier: MIT
#include "tools/commands.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "CLI/CLI.hpp"
#include "compare/noise_table.h"
#include "page/html_report.h"
#include "run/imported_scene.h"
#include "run/output/run_output.h"
#include "run/run.h"
#include "support/command_line.h"
#include "support/duration.h"
#include "support/failure.h"
#include "support/output_file.h"
#include "tools/solver_names.h"
#include "tools/words.h"

namespace cairn::cli {
namespace {

/// What was typed behind the options of `cairn run`.
struct RunWords {
  SceneWords scenes;
  std::vector<std::string> imports;
  std::string solvers = "bullet-si,bullet-nncg,bullet-dantzig,cairn";
  EffortWords effort;
  SetupWords setup;
  std::string frames = "300", samples = "8", repeat = "1", warmup = "0";
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
  --iterations N             Bullet's solvers make N iterations; Cairn N sweeps, or up to 2N where it
                             takes no step; no clock: the same results each time
A solver may have iterations of its own: bullet-si@50, bullet-si@fit, cairn@10 (without a clock).

Solvers that fail are shown as FAILED, with frame and reason.
Exit codes: 0 fine, 1 a solver of Cairn failed, 2 usage, 3 a file or program cannot be used.)";

RunOptions Check(const RunWords& words) {
  RunOptions options;
  Parse(words.scenes, words.effort, &options);
  for (const std::string& path : words.imports) {
    options.scenes.push_back(ImportScene(path, options.seed));
  }
  if (options.scenes.empty()) {
    throw Failure(kUsage,
                  "cairn run needs SCENE, as in 'cairn run tower' ('cairn list scenes' shows all), "
                  "or a world that Bullet saved: --import FILE");
  }
  options.solvers = ParseSolvers(OwnSolverNames(SolverUser::kRun, words.solvers));
  options.frames = ParseInt("--frames", words.frames, 1, 1'000'000, "frames of 1/60 s to simulate");
  options.warmup = ParseInt("--warmup", words.warmup, 0, options.frames - 1,
                            "the first frames, which do not count");
  options.repeat = ParseInt("--repeat", words.repeat, 1, 1000, "times that everything is run");
  options.noise = words.noise;
  options.setup = Parse(words.setup);
  for (SolverChoice& solver : options.solvers) solver.threads = options.setup.threads;
  options.samples = ParseInt("--samples", words.samples, 0, 1000,
                             "frames at which the velocity error is measured");
  options.progress = ParseProgress(words.output);
  options.page = !words.report.empty();
  options.timelines = options.page || !words.trace.empty();
  if (!words.trace_frame.empty()) {
    if (words.trace.empty()) throw Failure(kUsage, "--trace-frame needs --trace FILE");
    options.trace_frame =
        ParseInt("--trace-frame", words.trace_frame, 0, options.frames - 1, "a frame of the run");
  }

  if (AnyFit(options) && !options.budget) {
    throw Failure(kUsage,
                  "iterations can only be made to fit a budget of time: add --budget 2ms, say");
  }
  return options;
}

int DoRun(const RunWords& words, const std::string& command) {
  const RunOptions options = Check(words);
  Apply(options.setup);
  const std::vector<ResultFile<RunResult>> files = {{words.json, &ToJson},
                                                    {words.csv, &ToCsv},
                                                    {words.markdown, &ToMarkdown},
                                                    {words.report, &ToHtml},
                                                    {words.trace, &ToTrace}};
  CheckWritable(files);
  const RunResult result = Run(options, command);
  fmt::print("{}", ToText(result));
  if (options.noise) fmt::print("{}\n", NoiseText(result));
  if (!words.output.quiet) fmt::print("{}", ReadingHelp(result));
  WriteFiles(files, result);
  return result.check_failed() ? kCheckFailed : kFine;
}

}  // namespace

Command AddRunCommand(CLI::App* app) {
  const auto words = std::make_shared<RunWords>();
  CLI::App* const run = app->add_subcommand(
      "run",
      "Simulate scenes with several solvers and measure time, error and what became of them");
  run->footer(kRunNotes);
  AddScenes(run, "run", &words->scenes);
  run->add_option("--import", words->imports,
                  "A world that Bullet saved (.bullet; saveBullet() of PyBullet), as a scene")
      ->type_name("FILE")
      ->allow_extra_args(false);
  const auto add = TextAdder(run);
  run->add_option("--solver", words->solvers, "Solvers, with commas between them")
      ->type_name("A,B,...")
      ->take_last()
      ->capture_default_str();
  add("--budget", &words->effort.budget,
      "Solver time for a frame, such as 2ms, 500us, 0.002s; or work, such as 100000units", "B");
  add("--iterations", &words->effort.iterations,
      "Iterations of solvers, or fit (below); default 10", "N");
  add("--frames", &words->frames, "Frames of 1/60 s; default 300", "N");
  AddSceneOptions(run, &words->scenes);
  add("--samples", &words->samples,
      "Frames at which the velocity error is measured, at most a quarter of all; default 8", "N");
  add("--warmup", &words->warmup,
      "Frames, the first ones, that are run and do not count; default 0", "N");
  add("--repeat", &words->repeat,
      "Runs everything N times: times are of all, the rest is of the first; default 1", "N");
  AddSetup(run, &words->setup);
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
