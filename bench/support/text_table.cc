// SPDX-License-Identifier: MIT
#include "support/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

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
  std::vector<std::vector<std::string>> lines(1);
  for (const Column& column : columns) {
    lines[0].push_back(column.name + (column.unit.empty() ? "" : " [" + column.unit + "]"));
  }
  lines.insert(lines.end(), rows.begin(), rows.end());
  std::vector<size_t> widths(columns.size(), 3);
  for (std::vector<std::string>& line : lines) {
    const size_t aligned = line.size() < columns.size() ? line.size() - 1 : line.size();
    for (size_t i = 0; i < aligned; ++i) widths[i] = std::max(widths[i], line[i].size());
    line.resize(columns.size());
  }
  const auto align_of = [this](size_t i) { return i < names ? Align::kLeft : Align::kRight; };
  std::string text;
  for (const std::vector<std::string>& line : lines) {
    for (size_t i = 0; i < line.size(); ++i) {
      text += "| " + Pad(line[i], widths[i], align_of(i)) + " ";
    }
    text += "|\n";
    if (&line != &lines[0]) continue;
    for (size_t i = 0; i < line.size(); ++i) {
      const std::string dashes(widths[i] + 1, '-');
      text += align_of(i) == Align::kLeft ? "|:" + dashes : "|" + dashes + ":";
    }
    text += "|\n";
  }
  return text;
}

TextTable TableOf(std::vector<std::string> columns) {
  TextTable table;
  for (std::string& name : columns) table.columns.push_back({std::move(name), ""});
  return table;
}

std::string FormatNumber(double value) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return "inf";
  const double size = std::abs(value);
  if (size == 0) return "0";
  if (size < 1e-3 || size >= 1e5) return fmt::format("{:.1e}", value);
  const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(size))), 0, 4);
  return fmt::format("{:.{}f}", value, decimals);
}

std::string FormatCount(std::int64_t count) { return count == 0 ? "-" : fmt::format("{}", count); }

std::string FormatCell(double value) {
  return std::isnan(value) ? "" : fmt::format("{:.6g}", value);
}

std::string FormatTime(double milliseconds) {
  if (std::isnan(milliseconds)) return "-";
  return fmt::format("{:.{}f}", milliseconds, milliseconds < 10 ? 3 : milliseconds < 100 ? 2 : 1);
}

}  // namespace cairn::cli
