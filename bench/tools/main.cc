// SPDX-License-Identifier: MIT
// The cairn tool: its command line. What the commands do is in the files of their names.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <memory>

#include "CLI/CLI.hpp"
#include "support/command.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/names.h"
#include "support/output_file.h"
#include "tools/commands.h"
#include "tools/precision.h"

namespace cairn::cli {
namespace {

using Arguments = std::vector<std::string>;

/// "cairn run small"
std::string FullName(const CLI::App& command) {
  const CLI::App* const parent = command.get_parent();
  return parent == nullptr ? command.get_name() : FullName(*parent) + " " + command.get_name();
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
    throw Failure(
        kUsage, fmt::format("'{}' is not expected here; see '{} --help'", word, FullName(command)));
  }
  throw Failure(kUsage, fmt::format("unknown option '{}': {}'{} --help' shows all", word,
                                    DidYouMean(word, names), FullName(command)));
}

/// The command that was asked for: itself, or the one of its parts.
const Command& AskedFor(const Command& command) {
  for (const Command& part : command.parts) {
    if (!part.app->parsed()) continue;
    for (const CLI::Option* option : command.app->get_options()) {
      if (option->count() == 0) continue;
      throw Failure(kUsage, fmt::format("'{}' stands alone: its options come after it, see "
                                        "'{} --help'",
                                        FullName(*part.app), FullName(*part.app)));
    }
    return AskedFor(part);
  }
  return command;
}

void AllowExtras(const Command& command) {
  command.app->allow_extras();
  for (const Command& part : command.parts) AllowExtras(part);
}

int RefuseSyntax(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);  // help or version was asked for
  throw Failure(kUsage, error.what());
}

Command AddDoctor(CLI::App* app) {
  struct Words {
    std::string json;
    bool only_bullet = false, verify = false, verify_worlds = false;
  };
  const auto words = std::make_shared<Words>();
  CLI::App* const doctor = app->add_subcommand(
      "doctor", "Look at this machine and this build, and how far timings can be trusted (1 s)");
  AddText(doctor, "--json", &words->json, "Write the same as JSON", "FILE");
  doctor->add_flag("--bullet", words->only_bullet, "Only the Bullet that this program runs with");
  doctor->add_flag("--verify", words->verify,
                   "Whether 36 worlds and matrices of the core and 104 worlds of Bullet come out "
                   "here as everywhere, to the bit (15 s)");
  doctor->add_flag("--verify-worlds", words->verify_worlds)->group("");
  return {doctor, [words](const std::string&) -> int {
            if (words->verify) return DoctorVerify();
            if (words->verify_worlds) return DoctorVerifyWorlds();
            words->only_bullet ? DoctorBullet() : Doctor(words->json);
            return kFine;
          }};
}

Command AddList(CLI::App* app) {
  struct Words {
    std::string what;
    bool json = false;
  };
  const auto words = std::make_shared<Words>();
  CLI::App* const list = app->add_subcommand("list", "List scenes, problems and solvers");
  list->add_option("what", words->what, "scenes, problems or solvers; default all of them")
      ->type_name("WHAT");
  list->add_flag("--json", words->json, "As JSON");
  return {list, [words](const std::string&) {
            const ListForm form = words->json ? ListForm::kJson : ListForm::kText;
            if (words->what.empty()) {
              ListAll(form);
              return kFine;
            }
            const Arguments kinds = {"scenes", "problems", "solvers"};
            void (*const lists[])(ListForm) = {&ListScenes, &ListProblems, &ListSolvers};
            lists[FindName("list", words->what, kinds, "write scenes, problems or solvers")](form);
            return kFine;
          }};
}

/// For the list of commands: what follows the word goes to cairn-play as it stands.
Command AddPlay(CLI::App* app) {
  CLI::App* const play = app->add_subcommand(
      "play", "Worlds side by side in a window: drag, shoot, change solvers while they run");
  return {play, [](const std::string&) { return kUsage; }};
}

/// `cairn` alone shows what there is, `cairn help run` is `cairn run --help`.
void TakeHelp(Arguments* arguments) {
  const bool help = !arguments->empty() && arguments->front() == "help";
  if (help) arguments->erase(arguments->begin());
  if (help || arguments->empty()) arguments->push_back("--help");
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
      "--float64, or --precision float64, with any command but play: with Bullet in double "
      "precision.\n"
      "'cairn COMMAND --help' or 'cairn help COMMAND' says more, 'cairn list' what there is to "
      "run.\n"
      "First tries: cairn run tower --budget 2ms, cairn solve journal-bearing");
  TakeHelp(&arguments);
  const Command commands[] = {AddDoctor(&app),        AddList(&app),
                              AddRunCommand(&app),    AddCompareCommand(&app),
                              AddRecordCommand(&app), AddSolveCommand(&app),
                              AddWorldsCommand(&app), AddPlay(&app)};
  Arguments names;
  for (const Command& command : commands) {
    AllowExtras(command);
    names.push_back(command.app->get_name());
  }
  CompleteCommand(names, &arguments);
  if (arguments.front() == "play") ContinueAsPlay({arguments.begin() + 1, arguments.end()});
  try {
    app.parse(Arguments(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& error) {
    return RefuseSyntax(app, error);
  }
  for (const Command& command : commands) {
    if (!command.app->parsed()) continue;
    const Command& asked = AskedFor(command);
    RefuseUnknown(*command.app);
    RefuseUnknown(*asked.app);
    return asked.action(WithoutPaths("cairn", typed));
  }
  return kUsage;
}

}  // namespace
}  // namespace cairn::cli

int main(int count, char** arguments) {
  try {
    const int code = cairn::cli::Main({arguments + 1, arguments + count});
    cairn::cli::FinishOutput();
    return code;
  } catch (const cairn::cli::Failure& failure) {
    fmt::print(stderr, "cairn: {}\n", failure.what());
    return failure.code();
  } catch (const std::exception& error) {
    // a full disk behind stdout, or no memory
    fmt::print(stderr, "cairn: {}\n", error.what());
    return cairn::cli::kBadInput;
  }
}
