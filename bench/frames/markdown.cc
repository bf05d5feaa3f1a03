// SPDX-License-Identifier: MIT
#include "frames/markdown.h"

#include <fmt/format.h>

#include <algorithm>

#include "support/machine/build_info.h"
#include "support/machine/machine.h"

namespace cairn::frames {

void MarkdownTable::Print() const {
  std::vector<size_t> widths(lines_.front().size(), 3);
  for (const auto& line : lines_) {
    for (size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  const auto print = [&](const std::vector<std::string>& line) {
    for (size_t i = 0; i < line.size(); ++i) {
      i == 0 ? fmt::print("| {:<{}} ", line[i], widths[i])
             : fmt::print("| {:>{}} ", line[i], widths[i]);
    }
    fmt::print("|\n");
  };
  print(lines_.front());
  for (size_t i = 0; i < widths.size(); ++i) {
    fmt::print("|{:-<{}}{}", "", widths[i] + 1, i == 0 ? "-" : ":");
  }
  fmt::print("|\n");
  std::for_each(lines_.begin() + 1, lines_.end(), print);
  fmt::print("\n");
}

void PrintOrigin(const std::string& title, const std::string& command) {
  const cli::Machine machine = cli::DescribeMachine();
  const cli::BuildInfo build = cli::DescribeBuild();
  fmt::print("# {}\n\n", title);
  fmt::print("- machine: {}, {} cores, load {}\n", machine.cpu, machine.cores,
             machine.load_average);
  fmt::print("- build: Cairn {}, {}, {}; frames by {}\n", build.version, build.build_type,
             build.compiler, cli::DescribeBullet(build));
  fmt::print("- command: `{}`\n", command);
#if !defined(__OPTIMIZE__) || !defined(NDEBUG)
  fmt::print("- WARNING: not an optimised build, the figures mean nothing\n");
#endif
}

}  // namespace cairn::frames
