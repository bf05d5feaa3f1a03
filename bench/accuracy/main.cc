// SPDX-License-Identifier: MIT
// How accurate Cairn is at game speed: on given states, in closed loop, on a grid of extremes,
// under tension, and under many seeds.
#include <fmt/format.h>

#include <exception>
#include <string>
#include <vector>

#include "accuracy/command.h"
#include "support/arguments.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/machine/setup.h"
#include "support/output_file.h"

namespace cairn::accuracy {
namespace {

int Main(int count, char** arguments) {
  CLI::App app("How accurate Cairn is at game speed, against Bullet and against sweeps alone.",
               "cairn_accuracy");
  app.require_subcommand(1);
  const cli::Command commands[] = {AddStatesCommand(&app), AddLoopCommand(&app),
                                   AddGridCommand(&app), AddTensionCommand(&app),
                                   AddStandCommand(&app)};
  const cli::Arguments typed = {arguments + 1, arguments + count};
  if (!cli::Read(cli::SpellOut(app, typed), &app)) return cli::kFine;
  cli::WarnOfTarget(app.get_name());
  for (const cli::Command& command : commands) {
    if (command.app->parsed()) return command.action(cli::WithoutPaths(app.get_name(), typed));
  }
  return cli::kUsage;
}

}  // namespace
}  // namespace cairn::accuracy

int main(int count, char** arguments) {
  try {
    const int code = cairn::accuracy::Main(count, arguments);
    cairn::cli::FinishOutput();
    return code;
  } catch (const cairn::cli::Failure& failure) {
    fmt::print(stderr, "cairn_accuracy: {}\n", failure.what());
    return failure.code();
  } catch (const std::exception& error) {
    fmt::print(stderr, "cairn_accuracy: {}\n", error.what());
    return cairn::cli::kCheckFailed;
  }
}
