// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cairn::cli {

/// Values over frames, or over time; NaN leaves a gap.
struct Series {
  std::string label;
  int style = 0;  ///< Colour, dashes and marker; see StyleOf().
  std::vector<double> x, y;
};

/// A picture of lines, the vertical axis logarithmic. Values of 0 are drawn at the lower edge.
struct LinePlot {
  enum class Scale {
    kLinear,       ///< From 0 to x_most.
    kLogarithmic,  ///< From the least positive x of the series to the largest; x of 0 at the edge.
  };
  std::string title;
  std::string unit;  ///< of the vertical axis
  std::vector<Series> series;
  Scale x_scale = Scale::kLinear;
  std::string x_label = "frame";
  double x_most = 1;  ///< Right end of a linear axis: the number of frames.
  /// Of the vertical axis at most; what is smaller is a solver that is exact.
  double most_decades = 8;
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
