// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace cairn::cli {

/// What was typed behind the name of a program.
using Arguments = std::vector<std::string>;

/// "cairn run small"
std::string FullName(const CLI::App& command);

/// "'cairn help run' says more"; of a program that has commands: "'cairn' shows what there is".
std::string WhereHelpIs(const CLI::App& command);

/// Arguments of a program with commands as they are read: the command, which may be shortened, in
/// full, and --help for what means it: no argument at all, or `help run`. Others stay as they are.
/// @throws Failure (kUsage) for an unknown command, or an option before it
Arguments SpellOut(const CLI::App& app, Arguments arguments);

/// Puts arguments into the options of a program and of its commands. Help and version are printed
/// where they are asked for.
/// @return whether anything else is to be done
/// @throws Failure (kUsage): a sentence that names what is missing, unknown or out of range, with
/// an example where one helps, and says where help is
bool Read(const Arguments& arguments, CLI::App* app);

}  // namespace cairn::cli
