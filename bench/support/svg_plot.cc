// SPDX-License-Identifier: MIT
#include "support/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace cairn::cli {
namespace {

constexpr double kWidth = 470, kHeight = 270;
constexpr double kLeft = 58, kRight = 12, kTop = 30, kBottom = 40;
constexpr int kMarkers = 10;  // on a line of many points
/// Solid, and dashes that can be told apart without colour.
constexpr std::string_view kDashes[] = {"", "7 3", "2 2.5", "9 3 2 3", "4 2", "12 4"};
constexpr int kStyles = static_cast<int>(std::size(kDashes));

std::string Marker(int style, double x, double y) {
  const double r = 3.4;
  const std::string place = fmt::format("class=\"m s{}\"", style % kStyles);
  switch (style % kStyles) {
    case 0:
      return fmt::format("<circle {} cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>", place, x, y, r);
    case 1:
      return fmt::format("<rect {} x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\"/>", place,
                         x - r, y - r, 2 * r, 2 * r);
    case 2:
      return fmt::format("<path {} d=\"M{:.1f} {:.1f}l{} {}h{}z\"/>", place, x, y - r - 0.6,
                         r + 0.8, 2 * r, -2 * (r + 0.8));
    case 3:
      return fmt::format("<path {} d=\"M{:.1f} {:.1f}l{} {}l{} {}l{} {}z\"/>", place, x, y - r - 1,
                         r + 1, r + 1, -r - 1, r + 1, -r - 1, -r - 1);
    case 4:
      return fmt::format("<path {} d=\"M{:.1f} {:.1f}l{} {}m0 {}l{} {}\"/>", place, x - r, y - r,
                         2 * r, 2 * r, -2 * r, -2 * r, 2 * r);
    default:
      return fmt::format("<path {} d=\"M{:.1f} {:.1f}v{}m{} {}h{}\"/>", place, x, y - r, 2 * r, -r,
                         -r, 2 * r);
  }
}

std::string LineStyle(int style) {
  const std::string_view dashes = kDashes[style % kStyles];
  const std::string dash = dashes.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", dashes);
  return fmt::format("class=\"l s{}\"{}", style % kStyles, dash);
}

/// Maps values to places in a LinePlot.
struct Axes {
  double x_least = 1, x_most = 10;  ///< Whole decades.
  double low = 1e-3, high = 1;      ///< Likewise.

  double X(double x) const {
    const double share = std::log(std::max(x, x_least) / x_least) / std::log(x_most / x_least);
    return kLeft + (kWidth - kLeft - kRight) * share;
  }
  double Y(double y) const {
    const double share = std::log(std::clamp(y, low, high) / low) / std::log(high / low);
    return kHeight - kBottom - (kHeight - kTop - kBottom) * share;
  }
};

/// The least and the largest of values that have a logarithm; largest 0 without any.
struct Extent {
  double least = INFINITY, most = 0;

  void Add(double value) {
    if (!(value > 0) || !std::isfinite(value)) return;
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

double DecadeBelow(double value) { return std::pow(10, std::floor(std::log10(value))); }
double DecadeAbove(double value) { return std::pow(10, std::ceil(std::log10(value))); }

Axes AxesOf(const LinePlot& plot) {
  Extent x, y;
  for (const Series& series : plot.series) {
    for (const double value : series.x) x.Add(value);
    for (const double value : series.y) y.Add(value);
  }
  Axes axes;
  if (x.most > 0) {
    axes.x_least = DecadeBelow(x.least);
    axes.x_most = DecadeAbove(x.most);
    if (axes.x_most == axes.x_least) axes.x_most *= 10;
  }
  if (y.most == 0) return axes;
  // More decades are a solver that is exact, or one that exploded: cut off below.
  axes.high = DecadeAbove(y.most * 1.05);
  axes.low = std::max(DecadeBelow(y.least * 0.95), axes.high * std::pow(10, -plot.most_decades));
  return axes;
}

std::string HorizontalLabels(const Axes& axes) {
  std::string svg;
  const int first = static_cast<int>(std::lround(std::log10(axes.x_least)));
  const int last = static_cast<int>(std::lround(std::log10(axes.x_most)));
  for (int exponent = first; exponent <= last; ++exponent) {
    // in the middle the last one would stick out
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"{}\">{:g}</text>",
                       axes.X(std::pow(10, exponent)), kHeight - kBottom + 16,
                       exponent == last ? "end" : "middle", std::pow(10, exponent));
  }
  return svg;
}

std::string Grid(const Axes& axes, const LinePlot& plot) {
  std::string svg;
  const double decades = std::log10(axes.high / axes.low);
  const int stride = decades > 5 ? 2 : 1;
  const int first = static_cast<int>(std::lround(std::log10(axes.low)));
  const int last = static_cast<int>(std::lround(std::log10(axes.high)));
  for (int exponent = first; exponent <= last; exponent += stride) {
    const double value = std::pow(10, exponent), y = axes.Y(value);
    svg += fmt::format(
        "<line class=\"g\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>"
        "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:g}</text>",
        kLeft, kWidth - kRight, y, y, kLeft - 6, y + 4, value);
  }
  return svg + HorizontalLabels(axes) +
         fmt::format(
             "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>"
             "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
             kWidth - kRight, kHeight - 8, Escape(plot.x_label), kLeft - 6, kTop - 10,
             Escape(plot.unit));
}

std::string Line(const Series& series, const Axes& axes) {
  std::string path, markers;
  bool pen_down = false;
  const size_t spacing = std::max<size_t>(1, series.y.size() / kMarkers);
  // Markers of different lines are kept apart.
  const size_t offset = spacing * (series.style % kStyles) / kStyles;
  for (size_t i = 0; i < series.y.size(); ++i) {
    if (std::isnan(series.y[i])) {
      pen_down = false;
      continue;
    }
    const double x = axes.X(series.x[i]), y = axes.Y(series.y[i]);
    path += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", x, y);
    pen_down = true;
    if (i % spacing == offset) markers += Marker(series.style, x, y);
  }
  return fmt::format("<path {} d=\"{}\"><title>{}</title></path>{}", LineStyle(series.style), path,
                     Escape(series.label), markers);
}

}  // namespace

std::string LinePlot::ToSvg() const {
  const Axes axes = AxesOf(*this);
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">"
      "<text class=\"t\" x=\"{}\" y=\"14\">{}</text>{}",
      kWidth, kHeight, Escape(title), kLeft, Escape(title), Grid(axes, *this));
  for (const Series& line : series) svg += Line(line, axes);
  return svg + "</svg>\n";
}

std::string StyleKey(int style) {
  return fmt::format(
      "<svg class=\"k\" viewBox=\"0 0 34 12\" aria-hidden=\"true\"><path {} d=\"M0 "
      "6H34\"/>{}</svg>",
      LineStyle(style), Marker(style, 17, 6));
}

std::string_view PlotStyleSheet() {
  return R"css(
:root{--s0:#0067b1;--s1:#c74a00;--s2:#8a5bb5;--s3:#00795a;--s4:#a8006d;--s5:#5c5c5c}
@media (prefers-color-scheme:dark){:root{--s0:#5ab4f5;--s1:#ff9257;--s2:#c3a0ee;--s3:#3ed2a4;--s4:#ff8fce;--s5:#bdbdbd}}
:root.paper{--s0:#0067b1;--s1:#c74a00;--s2:#8a5bb5;--s3:#00795a;--s4:#a8006d;--s5:#5c5c5c}
@media print{:root{--s0:#0067b1;--s1:#c74a00;--s2:#8a5bb5;--s3:#00795a;--s4:#a8006d;--s5:#5c5c5c}}
.s0{--c:var(--s0)}.s1{--c:var(--s1)}.s2{--c:var(--s2)}.s3{--c:var(--s3)}.s4{--c:var(--s4)}.s5{--c:var(--s5)}
svg{font:11px system-ui,sans-serif;width:100%;height:auto;display:block}
svg text{fill:var(--soft)}svg .t{fill:var(--ink);font-size:13px;font-weight:600}
svg .g{stroke:var(--rule);stroke-width:1}
svg .l{fill:none;stroke:var(--c);stroke-width:1.5;stroke-linejoin:round}
svg .m{fill:var(--paper);stroke:var(--c);stroke-width:1.5}
svg.k{width:34px;height:12px;display:inline-block;vertical-align:-1px;margin-right:7px}
)css";
}

std::string Escape(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

}  // namespace cairn::cli
