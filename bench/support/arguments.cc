// SPDX-License-Identifier: MIT
#include "support/arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "CLI/CLI.hpp"
#include "support/failure.h"
#include "support/names.h"

namespace cairn::cli {
namespace {

/// What may be written for an option, by its name or else by the type that its help shows.
constexpr std::pair<std::string_view, std::string_view> kSamples[] = {
    {"--solver", "cairn"},
    {"--seconds", "5"},
    {"--scale", "0.5"},
    {"--seeds", "0:100"},
    {"--kind", "tower"},
    {"--beside", "old.json"},
    {"--errors", "1e-1,1e-2"},
    {"--set", "eccentricity=0.5"},
    {"--start", "zero"},
    {"--order", "forward"},
    {"--tolerance", "1e-6"},
    {"--tol", "1e-9"},
    {"--omega", "1.5"},
    {"--simd", "scalar"},
    {"--pin", "0"},
    {"--threads", "2"},
    {"--progress", "never"},
    {"--threshold", "5%"},
    {"--error-threshold", "25%"},
    {"--json", "result.json"},
    {"--csv", "result.csv"},
    {"--markdown", "result.md"},
    {"--report", "report.html"},
    {"--trace", "trace.json"},
    {"--history", "history.csv"},
    {"--plot", "error.svg"},
    {"--import", "world.bullet"},
    {"--screenshot", "picture.png"},
    {"--window", "1440x810"},
    {"--scene", "tower"},
    {"--scenes", "tower,wall"},
    {"--iterations", "20"},
    {"OLD.json", "old.json"},
    {"NEW.json", "new.json"},
    {"SCENE", "tower"},
    {"WORLD", "tower"},
    {"FILE or GENERATOR", "slider"},
    {"DIR", "folder"},
    {"N,N-M,...", "40,90"},
    {"B", "2ms"},
    {"TIME", "2ms"},
    {"N", "10"},
    {"INT", "10"},
    {"UINT", "10"},
    {"FLOAT", "0.5"}};

std::vector<const CLI::App*> CommandsOf(const CLI::App& app) { return app.get_subcommands({}); }

/// Of an option its long name, "--out", and of what has no name its type, "SCENE".
std::string Label(const CLI::Option& option) {
  if (option.get_positional()) {
    const std::vector<std::string> types = Split(option.get_type_name(), '|');
    return fmt::format("{}", fmt::join(types, " or "));
  }
  if (!option.get_lnames().empty()) return "--" + option.get_lnames().front();
  return "-" + option.get_snames().front();
}

bool TakesValue(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// Empty if there is none.
std::string_view SampleOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  for (const std::string& name : {Label(option), type.substr(0, type.find(':'))}) {
    for (const auto& [known, sample] : kSamples) {
      if (known == name) return sample;
    }
  }
  return {};
}

/// As it is typed: "--budget 2ms", "tower".
std::string Usage(const CLI::Option& option) {
  if (!TakesValue(option)) return Label(option);
  const std::string_view sample = SampleOf(option);
  const std::string value = sample.empty() ? option.get_type_name() : std::string(sample);
  return option.get_positional() ? value : Label(option) + " " + value;
}

/// The part of a word that names an option.
std::string NameIn(const std::string& word) { return word.substr(0, word.find('=')); }

Arguments LongNames(const CLI::App& command) {
  Arguments names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// CLI11 would say that there is no command.
void RefuseBeforeCommand(const CLI::App& app, const Arguments& arguments) {
  const std::string word = NameIn(arguments.front());
  if (!word.starts_with("-") || app.get_option_no_throw(word) != nullptr) return;
  const CLI::App* owner = nullptr;
  for (const CLI::App* command : CommandsOf(app)) {
    if (command->get_option_no_throw(word) == nullptr) continue;
    const bool typed = std::ranges::find(arguments, command->get_name()) != arguments.end();
    if (owner == nullptr || typed) owner = command;
  }
  if (owner == nullptr) {
    throw Failure(kUsage, fmt::format("unknown option '{}': {}{}", word,
                                      DidYouMean(word, LongNames(app)), WhereHelpIs(app)));
  }
  std::string example = FullName(*owner);
  for (const CLI::Option* option : owner->get_options()) {
    if (option->get_positional()) example += " " + Usage(*option);
  }
  throw Failure(kUsage, fmt::format("{} comes after the command, as in '{} {}'; {}", word, example,
                                    Usage(*owner->get_option_no_throw(word)), WhereHelpIs(app)));
}

void CompleteCommand(const CLI::App& app, Arguments* arguments) {
  Arguments names = {"help"};
  for (const CLI::App* command : CommandsOf(app)) names.push_back(command->get_name());
  for (std::string& word : *arguments) {
    if (word.starts_with("-")) continue;
    const std::string help = fmt::format("'{} --help' shows all", FullName(app));
    word = names[FindName("command", word, names, help)];
    return;
  }
}

/// What is unknown comes back to us, so that the answer can name the nearest option.
void AllowExtras(CLI::App* app) {
  app->allow_extras();
  for (CLI::App* command : app->get_subcommands({})) AllowExtras(command);
}

void RefuseUnknown(const CLI::App& command) {
  const Arguments unknown = command.remaining();
  if (unknown.empty()) return;
  const Arguments names = LongNames(command);
  const std::string word = NameIn(unknown.front());
  if (!word.starts_with("-") || names.empty()) {
    throw Failure(
        kUsage, fmt::format("'{}' is not expected here; see '{} --help'", word, FullName(command)));
  }
  throw Failure(kUsage, fmt::format("unknown option '{}': {}'{} --help' shows all", word,
                                    DidYouMean(word, names), FullName(command)));
}

/// The innermost command that was typed; what nobody knows on the way there is refused.
const CLI::App& AskedFor(const CLI::App& app) {
  RefuseUnknown(app);
  for (const CLI::App* command : CommandsOf(app)) {
    if (command->parsed()) return AskedFor(*command);
  }
  return app;
}

std::string WhatIsMissing(const CLI::App& command) {
  std::vector<std::string> missing;
  std::string example = FullName(command);
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_required()) continue;
    example += " " + Usage(*option);
    if (option->count() == 0) missing.push_back(Label(*option));
  }
  if (missing.empty()) return fmt::format("{} needs a command", FullName(command));
  const std::string last = missing.back();
  missing.pop_back();
  return fmt::format("{} needs {}{}{}, as in '{}'", FullName(command), fmt::join(missing, ", "),
                     missing.empty() ? "" : " and ", last, example);
}

/// An option that has too few values, or one that it does not take.
std::string WrongValue(const CLI::App& command, std::string_view name) {
  const CLI::Option* const option = command.get_option_no_throw(std::string(name));
  if (option == nullptr) return fmt::format("{}: not understood", name);
  if (!TakesValue(*option)) return fmt::format("{} stands alone, without a value", name);
  return fmt::format("{} needs a value, such as '{}' ({})", name, Usage(*option),
                     option->get_description());
}

/// "from 1 to 100", from what CLI11 says: "1 to 100", with all digits of the largest number.
std::string Bounds(const CLI::Option& option, const std::string& text) {
  constexpr double kNoLimit = 1e300;
  const double least = std::strtod(text.c_str(), nullptr);
  const size_t to = text.find(" to ");
  const double most = to == std::string::npos ? least : std::strtod(text.c_str() + to + 4, nullptr);
  if (most < kNoLimit) return fmt::format("a number from {:.10g} to {:.10g}", least, most);
  const bool positive = option.get_type_name().find("POSITIVE") != std::string::npos;
  return positive ? "a number greater than 0" : fmt::format("a number of {:g} or more", least);
}

/// Names of a map as CLI11 shows it: "value in {wall->0,cpu->1} OR {0,1}".
std::vector<std::string> NamesOf(const std::string& text) {
  const size_t begin = text.find('{'), end = text.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  std::vector<std::string> names;
  for (const std::string& pair : Split(text.substr(begin + 1, end - begin - 1), ',')) {
    names.push_back(pair.substr(0, pair.find("->")));
  }
  return names;
}

/// What CLI11 says of a value that a check refused: "--frames: Value 0 not in range 1 to 100".
std::string NotAllowed(const CLI::App& command, const std::string& said) {
  constexpr std::string_view kValue = ": Value ", kRange = " not in range ", kCheck = ": Check ";
  const std::string name = said.substr(0, said.find(": "));
  const CLI::Option* const option = command.get_option_no_throw(name);
  const size_t range = said.find(kRange);
  if (option != nullptr && range != std::string::npos && said.find(kValue) == name.size()) {
    const size_t value = name.size() + kValue.size();
    return fmt::format("{} '{}': write {} ({})", name, said.substr(value, range - value),
                       Bounds(*option, said.substr(range + kRange.size())),
                       option->get_description());
  }
  const std::vector<std::string> names = NamesOf(said);
  if (said.find(kCheck) == name.size() && !names.empty()) {
    const size_t value = name.size() + kCheck.size();
    return fmt::format("{} '{}': write {}", name,
                       said.substr(value, said.find(" value in ") - value),
                       fmt::join(names, " or "));
  }
  return said;
}

/// "Could not convert: --seed = x"
std::string NotConverted(const CLI::App& command, const std::string& said) {
  constexpr std::string_view kStart = "Could not convert: ";
  const size_t equals = said.find(" = ");
  // what is no value for a flag
  if (!said.starts_with(kStart) || equals == std::string::npos) {
    return WrongValue(command, said.substr(0, said.find(':')));
  }
  const std::string name = said.substr(kStart.size(), equals - kStart.size());
  const CLI::Option* const option = command.get_option_no_throw(name);
  if (option == nullptr) return said;
  if (!TakesValue(*option)) return WrongValue(command, name);
  return fmt::format("{} '{}': not understood, write '{}', say ({})", name, said.substr(equals + 3),
                     Usage(*option), option->get_description());
}

/// The name of the option in "--size: 1 required N missing", "--quiet was given a ...".
std::string OptionIn(const std::string& said) {
  const size_t begin = said.find("-");
  if (begin == std::string::npos) return said;
  return said.substr(begin, said.find_first_of(": ,", begin) - begin);
}

[[noreturn]] void Refuse(const CLI::App& command, const std::string& why) {
  throw Failure(kUsage, fmt::format("{}; {}", why, WhereHelpIs(command)));
}

}  // namespace

std::string FullName(const CLI::App& command) {
  const CLI::App* const parent = command.get_parent();
  return parent == nullptr ? command.get_name() : FullName(*parent) + " " + command.get_name();
}

std::string WhereHelpIs(const CLI::App& command) {
  const std::string name = FullName(command);
  const size_t space = name.find(' ');
  if (!CommandsOf(command).empty() && space == std::string::npos) {
    return fmt::format("'{}' shows what there is", name);
  }
  if (space == std::string::npos) return fmt::format("'{} --help' says more", name);
  return fmt::format("'{} help{}' says more", name.substr(0, space), name.substr(space));
}

Arguments SpellOut(const CLI::App& app, Arguments arguments) {
  if (CommandsOf(app).empty()) return arguments;
  bool help = arguments.empty();
  while (!arguments.empty()) {
    RefuseBeforeCommand(app, arguments);
    CompleteCommand(app, &arguments);
    if (arguments.front() != "help") break;
    help = true;
    arguments.erase(arguments.begin());
  }
  if (help) arguments.push_back("--help");
  return arguments;
}

bool Read(const Arguments& arguments, CLI::App* app) {
  AllowExtras(app);
  try {
    app->parse(Arguments(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success& request) {
    app->exit(request);
    return false;
  } catch (const CLI::RequiredError&) {
    const CLI::App& asked = AskedFor(*app);
    Refuse(asked, WhatIsMissing(asked));
  } catch (const CLI::ArgumentMismatch& error) {
    const CLI::App& asked = AskedFor(*app);
    Refuse(asked, WrongValue(asked, OptionIn(error.what())));
  } catch (const CLI::ValidationError& error) {
    const CLI::App& asked = AskedFor(*app);
    Refuse(asked, NotAllowed(asked, error.what()));
  } catch (const CLI::ConversionError& error) {
    const CLI::App& asked = AskedFor(*app);
    Refuse(asked, NotConverted(asked, error.what()));
  } catch (const CLI::ParseError& error) {
    Refuse(AskedFor(*app), error.what());
  }
  AskedFor(*app);
  return true;
}

}  // namespace cairn::cli
