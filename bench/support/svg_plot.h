// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cairn::cli {

/// Values over time; NaN leaves a gap.
struct Series {
  std::string label;
  int style = 0;  ///< Colour, dashes and marker; see StyleOf().
  std::vector<double> x, y;
};

/// A picture of lines on logarithmic axes. What is 0 is drawn at the edge.
struct LinePlot {
  std::string title;
  std::string unit;  ///< of the vertical axis
  std::vector<Series> series;
  std::string x_label;
  /// Of the vertical axis at most; what is smaller is a solver that is exact.
  double most_decades = 8;

  std::string ToSvg() const;
};

/// The line and marker of a style, small, for a table or a legend.
std::string StyleKey(int style);

/// Rules that the pictures need in the page: colours for light, dark and paper.
std::string_view PlotStyleSheet();

/// Text made safe inside HTML and SVG.
std::string Escape(std::string_view text);

}  // namespace cairn::cli
