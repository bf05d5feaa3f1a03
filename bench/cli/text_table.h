// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace cairn::cli {

/// Cells under two lines of header (what, unit). The first column is aligned left, the rest right.
struct TextTable {
  struct Column {
    std::string name, unit;
  };
  std::vector<Column> columns;
  /// A row shorter than `columns` ends in a remark that runs across what is left.
  std::vector<std::vector<std::string>> rows;

  std::string ToText() const;
  std::string ToMarkdown() const;
};

}  // namespace cairn::cli
