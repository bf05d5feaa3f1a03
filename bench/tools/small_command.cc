// SPDX-License-Identifier: MIT
#include "tools/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "small/small.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/output_file.h"
#include "tools/seeds.h"
#include "tools/words.h"

namespace cairn::cli {
namespace {

/// What was typed behind the options of `cairn run small`.
struct SmallWords {
  std::vector<std::string> worlds;
  std::string seeds, kinds, slowest = "10", directions = "2";
  std::string frames = "220", warmup, samples = "8";
  bool hot = false;
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
         "\nwith their size; any other scene of 'cairn list scenes', too, as NAME or NAME:SIZE.\n"
         "With --seeds, random worlds as 'cairn worlds' draws them, but with ten iterations; "
         "next:\n"
         "cairn_frames parts --scene random:SEED\n"
         "Exit codes: 0 fine, 1 a solver of Cairn failed, 2 usage, 3 a file cannot be written.";
}

std::vector<SceneChoice> ChooseWorlds(const SmallWords& words) {
  if (words.seeds.empty()) {
    if (!words.kinds.empty()) throw Failure(kUsage, "--kind is of random worlds: add --seeds");
    return ParseSmallWorlds(words.worlds);
  }
  if (!words.worlds.empty()) {
    throw Failure(kUsage,
                  fmt::format("--seeds runs random worlds: leave out '{}'", words.worlds.front()));
  }
  std::vector<std::uint64_t> seeds = ParseSeedRange(words.seeds, std::numeric_limits<int>::max());
  KeepKinds(words.kinds, &seeds);
  return RandomWorlds(seeds);
}

SmallOptions Check(const SmallWords& words) {
  SmallOptions options;
  options.worlds = ChooseWorlds(words);
  TakeDirections(words.directions, &options.worlds);
  options.random = !words.seeds.empty();
  options.slowest =
      ParseInt("--slowest", words.slowest, 0, 1'000'000, "worlds that are shown one by one");
  options.frames = ParseInt("--frames", words.frames, 1, 1'000'000, "frames of 1/60 s to simulate");
  options.warmup = words.warmup.empty() ? std::min(kUsualWarmup, options.frames / 4)
                                        : ParseInt("--warmup", words.warmup, 0, options.frames - 1,
                                                   "the first frames, which do not count");
  options.samples = ParseInt("--samples", words.samples, 0, 1000,
                             "frames at which the velocity error is measured");
  options.cold = !words.hot;
  options.setup = Parse(words.setup);
  options.progress = ParseProgress(words.output);
  return options;
}

int DoSmall(const SmallWords& words, const std::string& command) {
  const SmallOptions options = Check(words);
  Apply(options.setup);
  CheckWritable(std::vector{words.json, words.markdown});
  const RunContext context = DescribeContext(command);
  const std::vector<SmallResult> worlds = RunSmall(options);
  std::vector<TextTable> tables;
  if (options.random) {
    tables = {KindsTable(worlds), SharesTable(worlds)};
    if (options.slowest > 0) tables.push_back(SlowestTable(worlds, options.slowest));
  } else {
    tables = {SmallTable(worlds)};
  }
  std::string markdown;
  for (const TextTable& table : tables) {
    const bool first = &table == &tables.front();
    fmt::print("{}{}", first ? "" : "\n", table.ToText());
    markdown += (first ? "" : "\n") + table.ToMarkdown();
  }
  if (!words.output.quiet) fmt::print("\n{}", SmallReadingHelp(options, context));
  if (!words.json.empty()) WriteFile(words.json, SmallToJson(options, worlds, context));
  if (!words.markdown.empty()) WriteFile(words.markdown, markdown);
  return AnyCairnFailed(worlds) ? kCheckFailed : kFine;
}

}  // namespace

Command AddSmallCommand(CLI::App* run) {
  const auto words = std::make_shared<SmallWords>();
  CLI::App* const small = run->add_subcommand(
      "small", "Small worlds, as most games have them, in one table: Cairn beside Bullet");
  small->footer(Notes());
  small
      ->add_option("world", words->worlds, "Worlds to run (below), NAME or NAME:SIZE; default: all")
      ->type_name("WORLD");
  const auto add = TextAdder(small);
  add("--seeds", &words->seeds, "Random worlds FROM to TO - 1 instead, by their kinds", "FROM:TO");
  add("--kind", &words->kinds, "Of these only worlds of these kinds; see cairn worlds --list",
      "K,...");
  add("--slowest", &words->slowest,
      "Of these the ones that take longest beside Bullet, one by one; default 10", "N");
  add("--frames", &words->frames, "Frames of 1/60 s, random worlds have their own; default 220",
      "N");
  add("--warmup", &words->warmup,
      "Frames, the first ones, that are run and do not count; default 20, at most a quarter", "N");
  add("--samples", &words->samples,
      "Frames at which the velocity error is measured, at most a quarter of all; default 8", "N");
  AddDirections(small, &words->directions);
  small->add_flag("--hot", words->hot, "Leaves out cold caches, which take the longest to measure");
  AddSetup(small, &words->setup);
  add("--json", &words->json, "Write everything that was measured", "FILE");
  add("--markdown", &words->markdown, "Write the table as Markdown", "FILE");
  AddOutputWords(small, &words->output);
  return {.app = small,
          .action = [words](const std::string& typed) { return DoSmall(*words, typed); }};
}

}  // namespace cairn::cli
