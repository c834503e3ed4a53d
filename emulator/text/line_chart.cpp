#include "emulator/text/line_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/text/text.h"

namespace kadr::text {
namespace {

// pixels of the drawing
constexpr double kWidth = 960, kPlotHeight = 360, kLeft = 76, kRight = 26, kBelow = 46;
constexpr double kLegendRow = 20, kSwatch = 26, kCharacter = 7.4;
constexpr double kPlotWidth = kWidth - kLeft - kRight;
constexpr int kTicksX = 10, kTicksY = 6;

ChartRange all_of(const LineChart& chart, double ChartPoint::*of) {
  ChartRange range{0, 0};
  bool first = true;
  const auto take = [&](const std::vector<ChartPoint>& points) {
    for (const ChartPoint& p : points) {
      if (std::isnan(p.*of)) continue;
      range.low = first ? p.*of : std::min(range.low, p.*of);
      range.high = first ? p.*of : std::max(range.high, p.*of);
      first = false;
    }
  };
  for (const ChartBand& band : chart.bands) {
    take(band.lower);
    take(band.upper);
  }
  for (const ChartLine& line : chart.lines) take(line.points);
  return range;
}

ChartRange not_empty(ChartRange range) {
  if (!(range.high > range.low)) range.high = range.low + (range.low == 0 ? 1 : std::fabs(range.low));
  return range;
}

class Drawing {
 public:
  explicit Drawing(const LineChart& chart) : chart_(chart) {
    x_ = not_empty(chart.x ? *chart.x : all_of(chart, &ChartPoint::x));
    if (chart.y) {
      y_ = not_empty(*chart.y);
    } else {
      y_ = all_of(chart, &ChartPoint::y);
      y_ = not_empty({std::min(y_.low, 0.0), 1.04 * y_.high});
    }
  }

  std::string text() {
    const std::string legend = legend_text();
    std::string out = fmt::format(
        "<svg viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-labelledby=\"{}_d\">\n"
        "<desc id=\"{}_d\">{}</desc>\n"
        "<clipPath id=\"{}_c\"><rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" "
        "height=\"{:.0f}\"/></clipPath>\n",
        kWidth, height(), chart_.id, chart_.id, xml_text(chart_.description), chart_.id, kLeft, top_,
        kPlotWidth, kPlotHeight);
    out += legend + axes();
    out += fmt::format("<g clip-path=\"url(#{}_c)\">\n", chart_.id);
    for (const ChartBand& band : chart_.bands) out += band_text(band);
    for (const ChartLine& line : chart_.lines)
      out += fmt::format("<path class=\"line {}\"{} d=\"{}\"/>\n", line.style,
                         line.opacity < 1 ? fmt::format(" opacity=\"{:.2f}\"", line.opacity) : "",
                         broken_path(line.points));
    return out + "</g>\n</svg>\n";
  }
  /// Of the whole drawing; known once its text is.
  double height() const { return top_ + kPlotHeight + kBelow; }

 private:
  double across(double x) const { return kLeft + (x - x_.low) / (x_.high - x_.low) * kPlotWidth; }
  double down(double y) const { return top_ + kPlotHeight - (y - y_.low) / (y_.high - y_.low) * kPlotHeight; }

  /// Swatches and labels in rows above the plot; sets where the plot begins.
  std::string legend_text() {
    std::string out;
    double x = kLeft, y = 14;
    const auto entry = [&](const std::string& label, const std::string& swatch) {
      const double width = kSwatch + 8 + kCharacter * static_cast<double>(display_width(label)) + 18;
      if (x > kLeft && x + width > kWidth) {
        x = kLeft;
        y += kLegendRow;
      }
      out += fmt::format(
          "<g transform=\"translate({:.0f},{:.0f})\">{}<text x=\"{:.0f}\" y=\"4\">{}</text></g>\n", x, y,
          swatch, kSwatch + 8, xml_text(label));
      x += width;
    };
    for (const ChartLine& line : chart_.lines)
      if (!line.label.empty())
        entry(line.label,
              fmt::format("<path class=\"line {}\"{} d=\"M0 0H{:.0f}\"/>", line.style,
                          line.opacity < 1 ? fmt::format(" opacity=\"{:.2f}\"", line.opacity) : "", kSwatch));
    for (const ChartBand& band : chart_.bands)
      if (!band.label.empty())
        entry(band.label, fmt::format("<rect class=\"{}\" y=\"-6\" width=\"{:.0f}\" height=\"12\"/>",
                                      band.style, kSwatch));
    top_ = y + 18;
    return out;
  }

  std::string axes() const {
    std::string out;
    const std::vector<double> xs = nice_ticks(x_, kTicksX), ys = nice_ticks(y_, kTicksY);
    const double x_step = xs.size() > 1 ? xs[1] - xs[0] : 1, y_step = ys.size() > 1 ? ys[1] - ys[0] : 1;
    const double bottom = top_ + kPlotHeight;
    for (const double x : xs)
      out += fmt::format(
          "<path class=\"grid\" d=\"M{0:.1f} {1:.1f}V{2:.1f}\"/>"
          "<text class=\"x\" x=\"{0:.1f}\" y=\"{3:.1f}\">{4}</text>\n",
          across(x), top_, bottom, bottom + 17, tick_text(x, x_step));
    for (const double y : ys)
      out += fmt::format(
          "<path class=\"grid\" d=\"M{0:.1f} {1:.1f}H{2:.1f}\"/>"
          "<text class=\"y\" x=\"{3:.1f}\" y=\"{4:.1f}\">{5}</text>\n",
          kLeft, down(y), kWidth - kRight, kLeft - 8, down(y) + 4, tick_text(y, y_step));
    out += fmt::format("<path class=\"frame\" d=\"M{0:.1f} {1:.1f}V{2:.1f}H{3:.1f}\"/>\n", kLeft, top_,
                       bottom, kWidth - kRight);
    out += fmt::format("<text class=\"x name\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", kLeft + kPlotWidth / 2,
                       bottom + 38, xml_text(chart_.x_label));
    return out +
           fmt::format("<text class=\"x name\" transform=\"translate(14,{:.1f}) rotate(-90)\">{}</text>\n",
                       top_ + kPlotHeight / 2, xml_text(chart_.y_label));
  }

  /// Points that matter: those within x and a neighbour on either side, at most four per pixel column.
  std::vector<ChartPoint> thinned(const std::vector<ChartPoint>& points) const {
    const auto before = [](const ChartPoint& p, double x) { return p.x < x; };
    auto first = std::lower_bound(points.begin(), points.end(), x_.low, before);
    auto end = std::lower_bound(points.begin(), points.end(), x_.high, before);
    if (first != points.begin()) --first;
    for (int i = 0; i < 2 && end != points.end(); ++i) ++end;
    if (static_cast<double>(end - first) <= 2 * kPlotWidth) return {first, end};
    std::vector<ChartPoint> out;
    while (first != end) {
      const double column = std::floor(across(first->x));
      auto next = first, low = first, high = first;
      for (; next != end && std::floor(across(next->x)) == column; ++next) {
        if (next->y < low->y) low = next;
        if (next->y > high->y) high = next;
      }
      std::vector<decltype(first)> kept = {first, low, high, next - 1};
      std::sort(kept.begin(), kept.end());
      kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
      for (const auto at : kept) out.push_back(*at);
      first = next;
    }
    return out;
  }

  std::string path(const std::vector<ChartPoint>& points, char begin) const {
    std::string out;
    for (const ChartPoint& p : thinned(points)) {
      // far outside the frame a line goes on in the right direction, and its numbers stay short
      const double y = std::clamp(down(p.y), top_ - 4 * kPlotHeight, top_ + 5 * kPlotHeight);
      out += fmt::format("{}{:.1f} {:.1f}", out.empty() ? begin : 'L', across(p.x), y);
    }
    return out;
  }

  /// One path for each run of points that are numbers.
  std::string broken_path(const std::vector<ChartPoint>& points) const {
    const auto no_value = [](const ChartPoint& p) { return std::isnan(p.y); };
    std::string out;
    for (auto begin = points.begin(); begin != points.end();) {
      const auto end = std::find_if(begin, points.end(), no_value);
      out += path({begin, end}, 'M');
      begin = std::find_if_not(end, points.end(), no_value);
    }
    return out;
  }

  std::string band_text(const ChartBand& band) const {
    std::vector<ChartPoint> back = thinned(band.lower);
    std::string way_back;
    for (auto p = back.rbegin(); p != back.rend(); ++p)
      way_back += fmt::format("L{:.1f} {:.1f}", across(p->x),
                              std::clamp(down(p->y), top_ - 4 * kPlotHeight, top_ + 5 * kPlotHeight));
    return fmt::format("<path class=\"{}\" d=\"{}{}Z\"/>\n", band.style, path(band.upper, 'M'), way_back);
  }

  const LineChart& chart_;
  ChartRange x_, y_;
  double top_ = 0;
};

}  // namespace

std::string render_svg(const LineChart& chart) { return draw_svg(chart).text; }

SvgChart draw_svg(const LineChart& chart) {
  Drawing drawing(chart);
  std::string text = drawing.text();
  return {std::move(text), kWidth, drawing.height()};
}

std::vector<double> nice_ticks(const ChartRange& range, int wanted) {
  const double width = range.high - range.low;
  double step = 1;
  while (step * wanted < width) step *= 10;
  while (step * wanted > width * 10) step /= 10;
  // now 1 to 10 times too wide: the finest of 1, 2, 5 and 10 tenths that is wide enough
  for (const double part : {0.1, 0.2, 0.5}) {
    if (part * step * wanted < width) continue;
    step *= part;
    break;
  }
  std::vector<double> ticks;
  const double slack = 1e-9 * width;
  for (double i = std::ceil((range.low - slack) / step); i * step <= range.high + slack; ++i) {
    ticks.push_back(i * step);
    if (ticks.size() > 100) break;
  }
  return ticks;
}

std::string tick_text(double value, double step) {
  if (std::fabs(value) >= 1e7 || step < 1e-6) return fmt::format("{:.6g}", value);
  int decimals = 0;
  for (double unit = 1; decimals < 6 && unit > step * (1 + 1e-9); unit /= 10) ++decimals;
  return fixed(value, decimals);
}

}  // namespace kadr::text
