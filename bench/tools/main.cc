// SPDX-License-Identifier: MIT
// The cairn tool: its command line. What the commands do is in the files of their names.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <utility>

#include "CLI/CLI.hpp"
#include "support/arguments.h"
#include "support/command.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/names.h"
#include "support/output_file.h"
#include "tools/commands.h"
#include "tools/precision.h"

namespace cairn::cli {
namespace {

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
                   "Whether worlds and matrices of the core and worlds of Bullet come out here as "
                   "everywhere, to the bit (15 s)");
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

int Main(Arguments arguments) {
  const std::string precision = TakePrecision(&arguments);
  const Arguments typed = arguments;
  if (!precision.empty() && precision != OwnPrecision()) ContinueAs(precision, arguments);

  CLI::App app("Cairn: constraint solvers for game physics under a frame budget, measured.",
               "cairn");
  app.set_version_flag("--version", CAIRN_VERSION);
  // taken out before, and named to whoever misspells them
  app.add_flag("--float64")->group("");
  app.add_flag("--precision")->group("");
  app.require_subcommand(1);
  app.footer(
      "--float64, or --precision float64, with any command but play: with Bullet in double "
      "precision.\n"
      "'cairn COMMAND --help' or 'cairn help COMMAND' says more, 'cairn list' what there is to "
      "run.\n"
      "First tries: cairn run tower --budget 2ms, cairn solve journal-bearing");
  const Command commands[] = {AddDoctor(&app),        AddList(&app),
                              AddRunCommand(&app),    AddCompareCommand(&app),
                              AddRecordCommand(&app), AddSolveCommand(&app),
                              AddWorldsCommand(&app), AddPlay(&app)};
  arguments = SpellOut(app, std::move(arguments));
  if (arguments.front() == "play") ContinueAsPlay({arguments.begin() + 1, arguments.end()});
  if (!Read(arguments, &app)) return kFine;
  for (const Command& command : commands) {
    if (!command.app->parsed()) continue;
    return AskedFor(command).action(WithoutPaths("cairn", typed));
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
