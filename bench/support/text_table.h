// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
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
  /// With cells as wide as their column, to be read as it is.
  std::string ToMarkdown() const;
};

/// A table without units, of which the first column is names.
TextTable TableOf(std::vector<std::string> columns);

/// Three digits: "0.0312", "12.4", "3.1e-06"; "-" for NaN.
std::string FormatNumber(double value);
/// "-" for 0.
std::string FormatCount(std::int64_t count);
/// A cell of a CSV file: six digits; empty for NaN.
std::string FormatCell(double value);
/// A time [ms] to the microsecond where it is short.
std::string FormatTime(double milliseconds);

}  // namespace cairn::cli
