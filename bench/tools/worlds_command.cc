// SPDX-License-Identifier: MIT
#include "tools/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "CLI/CLI.hpp"
#include "campaign/campaign_output.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/machine/setup.h"
#include "support/names.h"
#include "support/output_file.h"
#include "tools/seeds.h"
#include "tools/solver_names.h"

namespace cairn::cli {
namespace {

/// What was typed behind the options of `cairn worlds`.
struct WorldsWords {
  std::string seeds, seed, solvers = "cairn,cairn-sweeps,cairn-work,cairn-always", kinds;
  std::string seconds = "5", scale = "1", unit = "1", jobs, json, shrink, beside, against,
              doubts = "0";
  bool list = false, report = false, audit = false, bits = false;
  bench::WorldSeed conditions;
  OutputWords output;
};

constexpr const char* kHowToRead = R"(
fly       a body faster than 60 m/s and twice as fast as in any run of Bullet, or not a number
audit     impulses of a substep that are worth less than none: they put energy in
restless  faster than 3 m/s in the last quarter, where every run of Bullet is below 1 m/s; in
          brackets one more, with 10,000 iterations, that tells whether accuracy alone does it
gap       a joint gap, or penetr, above 3 times that of Bullet with the iterations of the world and
          with 10, and 0.1 m
momentum  in free fall, relative drift above 1e-3 and 3 times Bullet's
bits      --bits: other bits with other SIMD targets or more threads
asleep    worlds in which all bodies fell asleep, of those in which they may
bullet    the iterations of the world; fly: above 60 m/s; restless: with 10, not with 100
ratio     geometric mean of ratios to bullet, of runs' largest gap, deepest penetration, fastest
          body of the last quarter and time, where bullet has more than 1 mm or 1 cm/s; -/+: in how
          many it is more than a tenth smaller or larger; CPU: collisions and audits included
against   --against: the same to before, of worlds with other bits
docs/worlds.md says more. Next: cairn worlds --seed N --report
)";
constexpr const char* kWorldsNotes =
    "A seed is a world, the same bits each time; its kind is the seed modulo the number of kinds.\n"
    "Exit codes: 0 fine, 1 an oracle failed, 2 usage, 3 a file cannot be written.";
constexpr long long kMostSeed = 1'000'000'000'000;

std::vector<std::uint64_t> ParseSeeds(const WorldsWords& words) {
  if (!words.seed.empty()) {
    return {static_cast<std::uint64_t>(
        ParseCount("--seed", words.seed, 0, kMostSeed, "the number of a world"))};
  }
  if (words.seeds.empty()) {
    throw Failure(kUsage,
                  "cairn worlds needs --seeds FROM:TO or --seed N, as in 'cairn worlds --seeds "
                  "0:100'; 'cairn help worlds' says more");
  }
  return ParseSeedRange(words.seeds, kMostSeed);
}

std::vector<bench::Variant> ParseVariants(const std::string& typed) {
  std::vector<std::string> names;
  for (const bench::Variant& variant : bench::CairnVariants()) names.push_back(variant.name);
  std::vector<bench::Variant> variants;
  for (const std::string& word : Split(typed, ',')) {
    const size_t index = FindName("solver", word, names, "'cairn list solvers' shows all");
    variants.push_back(bench::CairnVariants()[index]);
  }
  if (variants.empty()) throw Failure(kUsage, "--solver names no solver");
  return variants;
}

bench::CampaignOptions Check(const WorldsWords& words) {
  bench::CampaignOptions options;
  options.seeds = ParseSeeds(words);
  KeepKinds(words.kinds, &options.seeds);
  options.variants = ParseVariants(OwnSolverNames(SolverUser::kWorlds, words.solvers));
  options.trial.world = words.conditions;
  options.trial.seconds =
      ParseNumber("--seconds", words.seconds, 0.01, 3600, "simulated seconds of each world");
  options.trial.world.scale =
      ParseNumber("--scale", words.scale, 0.01, 1, "the share of their size that worlds have");
  options.trial.audit_every = words.audit || words.report ? 1 : 10;
  options.trial.world.unit =
      ParseNumber("--unit", words.unit, 1e-3, 1e4, "units of length in a metre");
  const bench::WorldSeed& on = words.conditions;
  if (options.trial.world.unit != 1 && (on.played || on.moving || on.dragged || on.pressed)) {
    throw Failure(kUsage,
                  "--unit goes without --played, --dragged, --pressed and --moving: in metres");
  }
  const int cores = std::max(1u, std::thread::hardware_concurrency());
  options.jobs = words.jobs.empty()
                     ? cores
                     : ParseInt("--jobs", words.jobs, 1, 1024, "worlds run side by side");
  options.bullet = ReadBulletRuns(Split(words.beside, ','), options);
  return options;
}

std::vector<bench::WorldResult> RunWithProgress(bench::CampaignOptions options, ProgressMode mode) {
  Progress progress(mode);
  const size_t all = options.seeds.size();
  options.progress = [&](size_t done) {
    progress.Show(fmt::format("worlds: {} of {}", done, all), double(done) / double(all));
  };
  return bench::RunWorlds(options);
}

void ListKinds() {
  for (const bench::Kind& kind : bench::Kinds()) {
    fmt::print("{:<16} {}\n", kind.name, kind.description);
  }
}

int DoWorlds(const WorldsWords& words, const std::string& command) {
  if (words.list) {
    ListKinds();
    return kFine;
  }
  const bench::CampaignOptions options = Check(words);
  const int doubts = ParseInt("--doubts", words.doubts, 0, 1'000'000, "runs that may fail");
  EarlierRuns earlier;
  if (!words.against.empty()) earlier = ReadEarlierRuns(words.against, options);
  if (!words.json.empty()) CheckWritable(words.json);
  if (!words.shrink.empty()) CheckFolder(words.shrink);
  WarnOfTarget();
  std::vector<bench::WorldResult> results = RunWithProgress(options, ParseProgress(words.output));
  if (words.bits) CheckBits(options, &results);
  for (const bench::WorldResult& result : results) {
    if (!words.report) break;
    bench::WorldSeed seed = options.trial.world;
    seed.seed = result.seed;
    fmt::print("{}\n", WorldReport(result, DescribeWorld(seed), options.variants));
  }
  if (!words.report) {
    fmt::print("{}\n", WorldTables(results, options.variants, words.bits));
    fmt::print("{}\n", BesideTable(results, options.variants));
  }
  fmt::print("{}", FailedWorlds(results, options.variants));
  if (!words.against.empty()) {
    fmt::print("\n{}", AgainstTable(results, options.variants, earlier));
  }
  if (!words.output.quiet && !words.report) fmt::print("{}", kHowToRead);
  if (!words.json.empty()) WriteFile(words.json, WorldsToJson(options, results, command));
  if (!words.shrink.empty()) {
    fmt::print("\nshrunk:\n{}", ShrinkFailures(options, results, words.shrink));
  }
  return bench::AnyFails(results, doubts) ? kCheckFailed : kFine;
}

}  // namespace

Command AddWorldsCommand(CLI::App* app) {
  const auto words = std::make_shared<WorldsWords>();
  CLI::App* const worlds = app->add_subcommand(
      "worlds", "Run random worlds with Cairn and Bullet, and say which of them go wrong");
  worlds->footer(kWorldsNotes);
  const auto add = TextAdder(worlds);
  add("--seeds", &words->seeds, "Worlds FROM to TO - 1", "FROM:TO");
  add("--seed", &words->seed, "One world", "N");
  worlds->get_option("--seed")->excludes("--seeds");
  add("--solver", &words->solvers,
      "Of cairn, cairn-sweeps, cairn-work, cairn-always, cairn-parts, see cairn list solvers; "
      "default: all but the last",
      "A,B,...");
  add("--kind", &words->kinds, "Only worlds of these kinds; see --list", "K,...");
  add("--seconds", &words->seconds, "Simulated time of each world; default 5", "S");
  add("--scale", &words->scale, "Smaller worlds: share of their size, at most 1; default 1", "X");
  add("--jobs", &words->jobs, "Worlds run side by side; default: as many as cores", "N");
  add("--json", &words->json, "Write everything about every world", "FILE");
  add("--doubts", &words->doubts,
      "So many runs may fail restless, gap or penetr, which alone prove nothing; default 0", "N");
  add("--beside", &words->beside,
      "Takes Bullet's runs from results of --json of the same worlds, where they have them",
      "FILE,...");
  add("--against", &words->against,
      "Says how runs differ from those in results of --json, of another build or other conditions",
      "FILE");
  add("--shrink", &words->shrink,
      "Make failures smaller, and write them and their worst frame into a folder", "DIR");
  for (const bench::Condition& condition : bench::Conditions()) {
    worlds->add_flag("--" + condition.name, words->conditions.*condition.on, condition.help);
  }
  add("--unit", &words->unit,
      "Units of length in a metre, 100 where worlds count in centimetres; without events; default "
      "1",
      "X");
  worlds->add_flag("--list", words->list, "Names the kinds of worlds");
  worlds->add_flag("--report", words->report, "Shows each world in detail; best with --seed");
  worlds->add_flag("--audit", words->audit, "Audits every substep, not every tenth");
  worlds->add_flag("--bits", words->bits,
                   "Runs all again with other SIMD targets and more threads: same bits?");
  AddOutputWords(worlds, &words->output);
  return {worlds, [words](const std::string& typed) { return DoWorlds(*words, typed); }};
}

}  // namespace cairn::cli
