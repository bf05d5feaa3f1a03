// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cairn::cli {

/// Values over frames; NaN leaves a gap.
struct Series {
  std::string label;
  int style = 0;  ///< Colour, dashes and marker; see StyleOf().
  std::vector<double> x, y;
};

/// A picture of lines, the vertical axis logarithmic. Values of 0 are drawn at the lower edge.
struct LinePlot {
  std::string title;
  std::string unit;  ///< of the vertical axis
  std::vector<Series> series;
  double x_most = 1;            ///< Right end of the horizontal axis: the number of frames.
  std::optional<double> limit;  ///< A horizontal line.
  std::string limit_label;

  std::string ToSvg() const;
};

/// One horizontal bar per label.
struct BarChart {
  struct Bar {
    std::string label;
    int style = 0;
    double value = 0;  ///< NaN: no bar, "-" instead of a number
  };
  std::string title;
  std::vector<Bar> bars;

  std::string ToSvg() const;
};

/// The line and marker of a style, small, for a table or a legend.
std::string StyleKey(int style);

/// Rules that the pictures need in the page: colours for light, dark and paper.
std::string_view PlotStyleSheet();

/// Text made safe inside HTML and SVG.
std::string Escape(std::string_view text);

}  // namespace cairn::cli
