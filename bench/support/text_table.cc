// SPDX-License-Identifier: MIT
#include "support/text_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace cairn::cli {
namespace {

enum class Align { kLeft, kRight };

std::string Pad(const std::string& text, size_t width, Align align) {
  return align == Align::kLeft ? fmt::format("{:<{}}", text, width)
                               : fmt::format("{:>{}}", text, width);
}

void EndLine(std::string* text) {
  text->erase(text->find_last_not_of(' ') + 1);
  *text += '\n';
}

}  // namespace

std::string TextTable::ToText() const {
  std::vector<size_t> widths;
  for (size_t i = 0; i < columns.size(); ++i) {
    size_t width = std::max(columns[i].name.size(), columns[i].unit.size());
    for (const auto& row : rows) {
      const bool is_remark = row.size() < columns.size() && i + 1 == row.size();
      if (i < row.size() && !is_remark) width = std::max(width, row[i].size());
    }
    widths.push_back(width);
  }
  const auto cell = [&](const std::string& text, size_t i) {
    return (i == 0 ? "" : "  ") + Pad(text, widths[i], i < names ? Align::kLeft : Align::kRight);
  };
  const bool has_units = std::any_of(columns.begin(), columns.end(),
                                     [](const Column& column) { return !column.unit.empty(); });
  std::string text;
  for (size_t i = 0; i < columns.size(); ++i) text += cell(columns[i].name, i);
  EndLine(&text);
  if (has_units) {
    for (size_t i = 0; i < columns.size(); ++i) text += cell(columns[i].unit, i);
    EndLine(&text);
  }
  for (const auto& row : rows) {
    for (size_t i = 0; i < row.size(); ++i) {
      const bool is_remark = row.size() < columns.size() && i + 1 == row.size();
      text += is_remark ? "  " + row[i] : cell(row[i], i);
    }
    EndLine(&text);
  }
  return text;
}

std::string TextTable::ToMarkdown() const {
  std::string text = "|", rule = "|";
  for (size_t i = 0; i < columns.size(); ++i) {
    text += fmt::format(" {}{} |", columns[i].name,
                        columns[i].unit.empty() ? "" : " [" + columns[i].unit + "]");
    rule += i < names ? " :-- |" : " --: |";
  }
  text += "\n" + rule + "\n";
  for (const auto& row : rows) {
    text += "|";
    for (size_t i = 0; i < columns.size(); ++i) {
      text += fmt::format(" {} |", i < row.size() ? row[i] : "");
    }
    text += "\n";
  }
  return text;
}

}  // namespace cairn::cli
