// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace cairn::cli {

/// Cells under two lines of header (what, unit), one where nothing has a unit. Names are aligned
/// left, numbers right.
struct TextTable {
  struct Column {
    std::string name, unit;
  };
  std::vector<Column> columns;
  size_t names = 1;  ///< Columns that hold names: the first ones.
  /// A row shorter than `columns` ends in a remark that runs across what is left.
  std::vector<std::vector<std::string>> rows;

  std::string ToText() const;
  std::string ToMarkdown() const;
};

}  // namespace cairn::cli
