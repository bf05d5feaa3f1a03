// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace cairn::cli {

/// A command of the tool: its options, and what it does once they are read.
struct Command {
  CLI::App* app = nullptr;
  /// @param typed  the command line as it can be shown to others
  /// @return exit code. @throws Failure
  std::function<int(const std::string& typed)> action;
  std::vector<Command> parts = {};  ///< Commands within it, `cairn run small`, say.
};

/// Adds an option that takes a text; the last of several counts.
void AddText(CLI::App* app, const char* name, std::string* text, const char* help,
             const char* type);

/// AddText() for one command: adder(name, text, help, type).
inline auto TextAdder(CLI::App* app) {
  return [app](const char* name, std::string* text, const char* help, const char* type) {
    AddText(app, name, text, help, type);
  };
}

/// Adds --progress and --quiet as every long command has them.
struct OutputWords {
  std::string progress = "auto";
  bool quiet = false;
};
void AddOutputWords(CLI::App* app, OutputWords* words);

}  // namespace cairn::cli
