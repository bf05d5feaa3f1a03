// SPDX-License-Identifier: MIT
#include "tools/commands.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "run/record.h"
#include "support/command_line.h"
#include "support/duration.h"
#include "support/failure.h"
#include "support/machine/setup.h"
#include "support/output_file.h"
#include "tools/solver_names.h"
#include "tools/words.h"

namespace cairn::cli {
namespace {

/// What was typed behind the options of `cairn record`.
struct RecordWords {
  SceneWords scenes;
  EffortWords effort;
  std::string frames, folder, solver = "cairn";
  bool force = false;
  OutputWords output;
};

constexpr long long kMostFrame = 1'000'000;

constexpr const char* kRecordNotes =
    R"(Writes what the solver was given in each of these frames, DIR/SCENE-000040.cairn: bodies, rows,
contacts, the impulses it starts from and its settings. 'cairn solve DIR/*.cairn' solves them with any
solver, on any machine. With a solver of Bullet's, the state is the one that solver made.

The same files come of any program that uses Cairn in Bullet: CAIRN_RECORD=DIR, and
CAIRN_RECORD_FRAMES=40,90 to choose frames. docs/recording.md has the format.

A file that is there already is not written over without --force.
Exit codes: 0 fine, 1 the solver failed, 2 usage, 3 a file cannot be written.)";

RecordOptions Check(const RecordWords& words) {
  RecordOptions options;
  RunOptions& run = options.run;
  Parse(words.scenes, words.effort, &run);
  run.solvers = ParseSolvers(OwnSolverNames(SolverUser::kRun, words.solver));
  if (run.solvers.size() != 1) throw Failure(kUsage, "--solver: one solver makes the frames");
  if (AnyFit(run)) {
    throw Failure(kUsage, "iterations that fit a budget make other frames each time");
  }
  if (!options.frames.Parse(words.frames) || options.frames.last() > kMostFrame) {
    throw Failure(kUsage, fmt::format("--frames '{}': write numbers from 0 to {}, such as 40,90 or "
                                      "40-49,90",
                                      words.frames, kMostFrame));
  }
  run.frames = static_cast<int>(options.frames.last()) + 1;
  run.progress = ParseProgress(words.output);
  options.folder = words.folder;
  while (options.folder.size() > 1 && options.folder.back() == '/') options.folder.pop_back();
  return options;
}

int DoRecord(const RecordWords& words) {
  const RecordOptions options = Check(words);
  CheckFolder(options.folder);
  if (!words.force) RefuseToOverwrite(options);
  WarnOfTarget();
  for (const RecordedFrame& frame : RecordScenes(options)) {
    fmt::print("{}  {} bodies, {} rows of joints and others, {} contact points, {:.1f} kB\n",
               frame.path, frame.bodies, frame.joint_rows, frame.points,
               1e-3 * static_cast<double>(frame.bytes));
  }
  return kFine;
}

}  // namespace

Command AddRecordCommand(CLI::App* app) {
  const auto words = std::make_shared<RecordWords>();
  CLI::App* const record =
      app->add_subcommand("record", "Write what solvers are given in frames of scenes to files");
  record->footer(kRecordNotes);
  AddScenes(record, "play", &words->scenes)->required();
  const auto add = TextAdder(record);
  add("--frames", &words->frames, "Frames to write, counted from 0: 40,90 or 40-49", "N,N-M,...");
  add("-o,--out", &words->folder, "Folder to write to; made if it is not there", "DIR");
  record->get_option("--frames")->required();
  record->get_option("--out")->required();
  add("--solver", &words->solver, "Solver that makes the frames; default cairn", "S");
  add("--budget", &words->effort.budget, "What a frame may cost, as for cairn run", "B");
  add("--iterations", &words->effort.iterations, "Iterations of the solver; default 10", "N");
  AddSceneOptions(record, &words->scenes);
  record->add_flag("--force", words->force, "Write over recordings that are there already");
  AddOutputWords(record, &words->output);
  return {record, [words](const std::string&) { return DoRecord(*words); }};
}

}  // namespace cairn::cli
