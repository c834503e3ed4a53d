#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Line charts as SVG text: no script, no embedded fonts, the same bytes for the same numbers. Colours
/// and dashes come from the page's style sheet by class, so that a chart reads on light and on dark ground.
namespace kadr::text {

struct ChartPoint {
  double x = 0, y = 0;
};

/// A line through points of ascending x; a y that is not a number breaks it.
struct ChartLine {
  std::string label;  ///< in the legend; empty: none
  std::string style;  ///< class of the style sheet
  std::vector<ChartPoint> points;
  double opacity = 1;
};

/// The area between two lines over the same x.
struct ChartBand {
  std::string label, style;
  std::vector<ChartPoint> lower, upper;
};

struct ChartRange {
  double low = 0, high = 1;
};

struct LineChart {
  std::string id;           ///< unique in a page, letters alone
  std::string description;  ///< what a screen reader says
  std::string x_label, y_label;
  std::vector<ChartBand> bands;  ///< drawn below the lines, in order
  std::vector<ChartLine> lines;
  std::optional<ChartRange> x, y;  ///< else all of the points, y from 0
};

/// Lines of more than two points per pixel keep first, lowest, highest and last of every pixel column.
std::string render_svg(const LineChart& chart);

/// The same with its size in pixels, to be placed in a larger drawing.
struct SvgChart {
  std::string text;
  double width = 0, height = 0;
};
SvgChart draw_svg(const LineChart& chart);

/// Tick positions: multiples of 1, 2 or 5 times a power of ten, about `wanted` of them.
std::vector<double> nice_ticks(const ChartRange& range, int wanted);
/// A tick with as many decimals as its neighbours need: "0", "250", "0.05".
std::string tick_text(double value, double step);

}  // namespace kadr::text
