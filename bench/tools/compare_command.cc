// SPDX-License-Identifier: MIT
#include "tools/commands.h"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "CLI/CLI.hpp"
#include "compare/comparison.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/output_file.h"

namespace cairn::cli {
namespace {

/// What was typed behind the options of `cairn compare`.
struct CompareWords {
  std::string before, after, threshold = "5%", error_threshold = "25%", json;
};

constexpr const char* kCompareNotes =
    R"(Both files are of the same command on the same machine, with 5 repetitions or more:
  cairn run tower wall --repeat 10 --samples 0 --json old.json

A regression is a change above the threshold that noise does not explain; from and to are what it may
be. Where noise hides a change of twice the threshold, a sentence says so. docs/compare.md says how.

Exit codes: 0 no regression, 1 a regression, 2 usage, or files that cannot be read or compared.)";

/// "5%", "5" or "0.5 %" as a share.
double ParseShare(const char* option, std::string text) {
  while (!text.empty() && (text.back() == '%' || text.back() == ' ')) text.pop_back();
  return ParseNumber(option, text, 0.1, 1000, "per cent, such as 5%") / 100;
}

int DoCompare(const CompareWords& words) {
  const Thresholds thresholds{.time = ParseShare("--threshold", words.threshold),
                              .error = ParseShare("--error-threshold", words.error_threshold)};
  const RunFile before = ReadRunFile(words.before), after = ReadRunFile(words.after);
  const Comparison comparison = Compare(before, after, thresholds);
  if (!words.json.empty()) WriteFile(words.json, ToJson(comparison));
  fmt::print("{}", ToText(comparison));
  return comparison.regressions.empty() ? kFine : kCheckFailed;
}

}  // namespace

Command AddCompareCommand(CLI::App* app) {
  const auto words = std::make_shared<CompareWords>();
  CLI::App* const compare = app->add_subcommand(
      "compare", "Compare two runs and find what became slower or less accurate");
  compare->footer(kCompareNotes);
  compare->add_option("old", words->before, "What cairn run --json wrote before")
      ->required()
      ->type_name("OLD.json");
  compare->add_option("new", words->after, "What it wrote after")
      ->required()
      ->type_name("NEW.json");
  AddText(compare, "--threshold", &words->threshold, "Slower by more than this counts; default 5%",
          "SHARE");
  AddText(compare, "--error-threshold", &words->error_threshold,
          "A mean residual larger by more than this counts; default 25%", "SHARE");
  AddText(compare, "--json", &words->json, "Write the same as JSON", "FILE");
  return {compare, [words](const std::string&) { return DoCompare(*words); }};
}

}  // namespace cairn::cli
