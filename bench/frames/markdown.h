// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace cairn::frames {

/// A table for people and for Markdown. The first column is text, the others are figures.
class MarkdownTable {
 public:
  explicit MarkdownTable(std::vector<std::string> columns) : lines_{std::move(columns)} {}
  /// @pre one cell per column
  void Add(std::vector<std::string> cells) { lines_.push_back(std::move(cells)); }
  /// To stdout.
  void Print() const;

 private:
  std::vector<std::vector<std::string>> lines_;
};

/// Prints a heading, and where, with what and by which command the figures below it were made.
void PrintOrigin(const std::string& title, const std::string& command);

}  // namespace cairn::frames
