// SPDX-License-Identifier: MIT
#include "tools/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "small/small.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/output_file.h"
#include "tools/words.h"

namespace cairn::cli {
namespace {

/// What was typed behind the options of `cairn run small`.
struct SmallWords {
  std::vector<std::string> worlds;
  std::string frames = "220", warmup, samples = "8";
  SetupWords setup;
  std::string json, markdown;
  OutputWords output;
};

constexpr int kUsualWarmup = 20;

std::string Notes() {
  std::string notes = "Worlds:";
  std::string line;
  for (const SceneChoice& world : SmallWorlds()) {
    notes +=
        fmt::format("\n  {:<14} {:>3}  {}", world.info->name, world.size, world.info->description);
  }
  return notes +
         "\nwith their size, as in 'cairn list scenes'.\n"
         "Exit codes: 0 fine, 1 a solver of Cairn failed, 2 usage, 3 a file cannot be written.";
}

SmallOptions Check(const SmallWords& words) {
  SmallOptions options;
  options.worlds = ParseSmallWorlds(words.worlds);
  options.frames = ParseInt("--frames", words.frames, 1, 1'000'000, "frames of 1/60 s to simulate");
  options.warmup = words.warmup.empty() ? std::min(kUsualWarmup, options.frames / 4)
                                        : ParseInt("--warmup", words.warmup, 0, options.frames - 1,
                                                   "the first frames, which do not count");
  options.samples = ParseInt("--samples", words.samples, 0, 1000,
                             "frames at which the velocity error is measured");
  options.setup = Parse(words.setup);
  options.progress = ParseProgress(words.output);
  return options;
}

int DoSmall(const SmallWords& words, const std::string& command) {
  const SmallOptions options = Check(words);
  Apply(options.setup);
  for (const std::string& path : {words.json, words.markdown}) {
    if (!path.empty()) CheckWritable(path);
  }
  const RunContext context = DescribeContext(command);
  const std::vector<SmallResult> worlds = RunSmall(options);
  const TextTable table = SmallTable(worlds);
  fmt::print("{}", table.ToText());
  if (!words.output.quiet) fmt::print("\n{}", SmallReadingHelp(options, context));
  if (!words.json.empty()) WriteFile(words.json, SmallToJson(options, worlds, context));
  if (!words.markdown.empty()) WriteFile(words.markdown, table.ToMarkdown());
  return AnyCairnFailed(worlds) ? kCheckFailed : kFine;
}

}  // namespace

Command AddSmallCommand(CLI::App* run) {
  const auto words = std::make_shared<SmallWords>();
  CLI::App* const small = run->add_subcommand(
      "small", "Small worlds, as most games have them, in one table: Cairn beside Bullet");
  small->footer(Notes());
  small->add_option("world", words->worlds, "Worlds to run (below); default: all")
      ->type_name("WORLD");
  const auto add = TextAdder(small);
  add("--frames", &words->frames, "Frames of 1/60 s; default 220", "N");
  add("--warmup", &words->warmup,
      "Frames, the first ones, that are run and do not count; default 20, at most a quarter", "N");
  add("--samples", &words->samples,
      "Frames at which the velocity error is measured, at most a quarter of all; default 8", "N");
  AddSetup(small, &words->setup);
  add("--json", &words->json, "Write everything that was measured", "FILE");
  add("--markdown", &words->markdown, "Write the table as Markdown", "FILE");
  AddOutputWords(small, &words->output);
  return {.app = small,
          .action = [words](const std::string& typed) { return DoSmall(*words, typed); }};
}

}  // namespace cairn::cli
