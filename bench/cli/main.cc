// SPDX-License-Identifier: MIT
// The cairn tool: its command line. What the commands do is in the files of their names.
#include <fmt/format.h>

#include <cstdio>
#include <functional>

#include "CLI/CLI.hpp"
#include "cli/command_line.h"
#include "cli/csv_output.h"
#include "cli/doctor.h"
#include "cli/duration.h"
#include "cli/failure.h"
#include "cli/html_report.h"
#include "cli/json_output.h"
#include "cli/list.h"
#include "cli/names.h"
#include "cli/output_file.h"
#include "cli/precision.h"
#include "cli/run.h"
#include "cli/run_tables.h"

namespace cairn::cli {
namespace {

using Arguments = std::vector<std::string>;

/// What was typed behind the options of `cairn run`.
struct RunWords {
  std::vector<std::string> scenes;
  std::string solvers = "bullet-si,bullet-nncg,bullet-dantzig,cairn";
  std::string budget, iterations, frames = "300", size, seed = "0", samples = "8";
  std::string progress = "auto";
  std::string json, csv, markdown, report;
  bool quiet = false;
};

constexpr const char* kRunNotes =
    R"(Time and iterations:
  --budget B                 Cairn stops at the clock after B of solver time. Bullet's solvers have
                             no clock: they make Bullet's default of 10 iterations, and frames that
                             took longer than B are counted ("over budget").
  --budget B --iterations N  the same with N iterations for Bullet's solvers
  --budget B --iterations fit
                             the iterations of Bullet's solvers are adapted from frame to frame to
                             fit B (at least 1), which is what users do by hand
  --iterations N             all make N iterations, Cairn without a clock: the same results each time
A solver may have iterations of its own: bullet-si@50, bullet-si@fit, cairn@10 (without a clock).

Solvers that fail are shown as FAILED, with frame and reason.
Exit codes: 0 fine, 1 a solver of Cairn failed, 2 usage, 3 a file or program cannot be used.)";

ProgressMode ParseProgress(const RunWords& words) {
  const Arguments names = {"auto", "always", "never"};
  constexpr ProgressMode kModes[] = {ProgressMode::kAuto, ProgressMode::kAlways,
                                     ProgressMode::kNever};
  const ProgressMode mode =
      kModes[FindName("progress mode", words.progress, names, "write auto, always or never")];
  return words.quiet ? ProgressMode::kNever : mode;
}

RunOptions Check(const RunWords& words) {
  RunOptions options;
  options.seed = ParseCount("--seed", words.seed, 0, 1'000'000'000,
                            "0: the scene as designed, else displaced by up to 0.1 mm");
  options.scenes = ParseScenes(words.scenes, words.size, options.seed);
  options.solvers = ParseSolvers(words.solvers);
  if (!words.budget.empty()) options.budget = ParseDuration("--budget", words.budget);
  if (!words.iterations.empty()) {
    options.iterations = ParseIterations("--iterations", words.iterations);
  }
  options.frames = static_cast<int>(
      ParseCount("--frames", words.frames, 1, 1'000'000, "frames of 1/60 s to simulate"));
  options.samples = static_cast<int>(ParseCount("--samples", words.samples, 0, 1000,
                                                "frames at which the velocity error is measured"));
  options.progress = ParseProgress(words);

  const auto is_fit = [](const IterationRule& rule) {
    return rule.kind == IterationRule::Kind::kFit;
  };
  bool fit = is_fit(options.iterations);
  for (const SolverChoice& solver : options.solvers) {
    fit = fit || (solver.own_iterations && is_fit(*solver.own_iterations));
  }
  if (fit && !options.budget) {
    throw Failure(kUsage, "iterations can only be made to fit a budget: add --budget 2ms, say");
  }
  return options;
}

int DoRun(const RunWords& words, const std::string& command) {
  const RunOptions options = Check(words);
  const std::pair<std::string, std::string (*)(const RunResult&)> files[] = {
      {words.json, &ToJson},
      {words.csv, &ToCsv},
      {words.markdown, &ToMarkdown},
      {words.report, &ToHtml}};
  for (const auto& [path, format] : files) {
    if (!path.empty()) CheckWritable(path);
  }
  const RunResult result = Run(options, command);
  fmt::print("{}", ToText(result));
  if (!words.quiet) fmt::print("{}", ReadingHelp(result));
  for (const auto& [path, format] : files) {
    if (!path.empty()) WriteFile(path, format(result));
  }
  return result.check_failed() ? kCheckFailed : kFine;
}

void AddRun(CLI::App* app, RunWords* words) {
  CLI::App* const run = app->add_subcommand(
      "run",
      "Simulate scenes with several solvers and measure time, error and what became of them");
  run->footer(kRunNotes);
  run->add_option("scene", words->scenes, "Scenes to run; 'all' for every one")
      ->required()
      ->type_name("SCENE...");
  const auto add = [run](const char* name, std::string* word, const char* help, const char* type) {
    run->add_option(name, *word, help)->type_name(type)->take_last();
  };
  run->add_option("--solver", words->solvers, "Solvers, with commas between them")
      ->type_name("A,B,...")
      ->take_last()
      ->capture_default_str();
  add("--budget", &words->budget, "Solver time for a frame, such as 2ms, 500us, 0.002s", "TIME");
  add("--iterations", &words->iterations, "Iterations of solvers, or fit (below); default 10", "N");
  add("--frames", &words->frames, "Frames of 1/60 s; default 300", "N");
  add("--size", &words->size, "Size of the scene; see cairn list scenes", "N");
  add("--seed", &words->seed,
      "Displaces bodies by up to 0.1 mm, differently for each seed; default 0: none", "N");
  add("--samples", &words->samples,
      "Frames at which the velocity error is measured, at most a quarter of all; default 8", "N");
  add("--json", &words->json, "Write everything that was measured", "FILE");
  add("--csv", &words->csv, "Write a line for each scene, solver and frame", "FILE");
  add("--markdown", &words->markdown, "Write the tables as Markdown", "FILE");
  add("--report", &words->report, "Write a page with pictures (HTML, needs no network)", "FILE");
  add("--progress", &words->progress, "Progress on stderr: auto (if a terminal), always, never",
      "WHEN");
  run->add_flag("--quiet", words->quiet, "Tables only: no progress, no help to read them");
}

/// CLI11 leaves what it does not know to us, so that the answer can name the nearest option.
void RefuseUnknown(const CLI::App& command) {
  const Arguments unknown = command.remaining();
  if (unknown.empty()) return;
  Arguments names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  const std::string word = unknown.front().substr(0, unknown.front().find('='));
  if (!word.starts_with("-") || names.empty()) {
    throw Failure(kUsage, fmt::format("'{}' is not expected here; see 'cairn {} --help'", word,
                                      command.get_name()));
  }
  throw Failure(kUsage, fmt::format("unknown option '{}': did you mean '{}'? 'cairn {} --help' "
                                    "shows all",
                                    word, Nearest(word, names), command.get_name()));
}

int RefuseSyntax(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);  // help or version was asked for
  throw Failure(kUsage, error.what());
}

int Main(Arguments arguments) {
  const std::string precision = TakePrecision(&arguments);
  const Arguments typed = arguments;
  if (!precision.empty() && precision != OwnPrecision()) ContinueAs(precision, arguments);

  CLI::App app("Cairn: constraint solvers for game physics under a frame budget, measured.",
               "cairn");
  app.set_version_flag("--version", CAIRN_VERSION);
  app.require_subcommand(1);
  app.footer(
      "--float64, or --precision float64, with any command: with Bullet in double precision.\n"
      "'cairn COMMAND --help' says more. A first try: cairn run tower --budget 2ms");
  std::string doctor_json, kind;
  bool only_bullet = false, list_json = false;
  CLI::App* const doctor = app.add_subcommand(
      "doctor", "Look at this machine and this build, and how far timings can be trusted (1 s)");
  doctor->add_option("--json", doctor_json, "Write the same as JSON")->type_name("FILE");
  doctor->add_flag("--bullet", only_bullet, "Only the Bullet that this program runs with");
  CLI::App* const list = app.add_subcommand("list", "List scenes or solvers");
  list->add_option("what", kind, "scenes or solvers")->required()->type_name("WHAT");
  list->add_flag("--json", list_json, "As JSON");
  RunWords words;
  AddRun(&app, &words);

  CompleteCommand({"doctor", "list", "run"}, &arguments);
  for (CLI::App* command : app.get_subcommands({})) command->allow_extras();
  try {
    app.parse(Arguments(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& error) {
    return RefuseSyntax(app, error);
  }
  CLI::App* const command = app.get_subcommands().front();
  RefuseUnknown(*command);
  if (command == doctor) {
    only_bullet ? DoctorBullet() : Doctor(doctor_json);
    return kFine;
  }
  if (command == list) {
    const Arguments kinds = {"scenes", "solvers"};
    const ListForm form = list_json ? ListForm::kJson : ListForm::kText;
    FindName("list", kind, kinds, "write scenes or solvers") == 0 ? ListScenes(form)
                                                                  : ListSolvers(form);
    return kFine;
  }
  return DoRun(words, WithoutPaths(typed));
}

}  // namespace
}  // namespace cairn::cli

int main(int count, char** arguments) {
  try {
    return cairn::cli::Main({arguments + 1, arguments + count});
  } catch (const cairn::cli::Failure& failure) {
    fmt::print(stderr, "cairn: {}\n", failure.what());
    return failure.code();
  }
}
