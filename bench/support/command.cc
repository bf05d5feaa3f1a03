// SPDX-License-Identifier: MIT
#include "support/command.h"

#include "CLI/CLI.hpp"

namespace cairn::cli {

void AddText(CLI::App* app, const char* name, std::string* text, const char* help,
             const char* type) {
  const auto is_there = [](const std::string& word) {
    return word.empty() ? std::string("is empty") : std::string();
  };
  // a check of the name that help shows would be shown in it
  app->add_option(name, *text, help)->type_name(type)->take_last()->check(is_there);
}

void AddOutputWords(CLI::App* app, OutputWords* words) {
  AddText(app, "--progress", &words->progress,
          "Progress on stderr: auto (if a terminal), always, never", "WHEN");
  app->add_flag("--quiet", words->quiet, "Tables only: no progress, no help to read them");
}

}  // namespace cairn::cli
