#include "emulator/log_tools/export/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "emulator/log_tools/export/export.h"
#include "emulator/text/text.h"

namespace kadr::log_tools {
namespace {

constexpr std::size_t kPieces = 2048;  ///< of a line: at least one per pixel column
constexpr std::size_t kStyles = 6;
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr double kFarthest = 1e300;  ///< a value beyond is drawn there, so that a chart's range is finite
constexpr double kGap = 12;          ///< pixels between charts

constexpr std::string_view kStyle = R"css(
svg { background: #ffffff; font: 12px system-ui, sans-serif; } text { fill: #1c2024; }
text.x { text-anchor: middle; } text.y { text-anchor: end; } text.name { fill: #5c646d; }
.grid { stroke: #dfe3e8; fill: none; } .frame { stroke: #5c646d; fill: none; }
.line { fill: none; stroke-width: 1.2; stroke-linejoin: round; }
.s0 { stroke: #0072b2; } .s1 { stroke: #d55e00; stroke-dasharray: 7 3; } .s2 { stroke: #009e73; stroke-dasharray: 2 3; }
.s3 { stroke: #a8487f; stroke-dasharray: 10 3 2 3; } .s4 { stroke: #8a5a00; } .s5 { stroke: #1c2024; stroke-dasharray: 4 2; }
)css";

/// Lowest and highest value of every piece, at its first and second half: as a pen would draw it. It lifts
/// where there is no value.
std::vector<text::ChartPoint> points_of(const std::vector<Envelope::Piece>& pieces) {
  std::vector<text::ChartPoint> points;
  points.reserve(2 * pieces.size());
  double before = 0;
  for (Envelope::Piece p : pieces) {
    p.low = std::clamp(p.low, -kFarthest, kFarthest);
    p.high = std::clamp(p.high, -kFarthest, kFarthest);
    if (p.empty) {
      if (!points.empty() && !std::isnan(points.back().y)) points.push_back({p.end_s, kNoValue});
      continue;
    }
    const double width = p.end_s - p.begin_s;
    if (p.low == p.high) {
      points.push_back({p.end_s, p.low});
    } else {
      // nearer end first, so that a slope stays one stroke
      const bool up = before - p.low <= p.high - before;
      points.push_back({p.begin_s + 0.5 * width, up ? p.low : p.high});
      points.push_back({p.end_s, up ? p.high : p.low});
    }
    before = points.back().y;
  }
  if (!points.empty() && std::isnan(points.back().y)) points.pop_back();
  return points;
}

/// Key of a chart: the unit, and for counts and codes the signal itself.
std::string chart_key(const Signal& signal) { return signal.unit.empty() ? signal.name : signal.unit; }

}  // namespace

std::vector<Envelope> read_envelopes(LogSamples& log, double from_s, std::size_t most) {
  const double piece_s = log.control_tick_s() * static_cast<double>(log.every());
  std::vector<Envelope> out(log.chosen().size(), Envelope(from_s, piece_s, most));
  for (Sample sample; log.next(sample);)
    for (std::size_t k = 0; k < out.size(); ++k) out[k].add(sample.t_s, sample.value[k]);
  return out;
}

std::vector<text::LineChart> charts_of(const std::vector<Signal>& signals,
                                       const std::vector<std::vector<Envelope::Piece>>& pieces) {
  std::vector<text::LineChart> charts;
  std::map<std::string, std::size_t> place;
  for (std::size_t k = 0; k < signals.size(); ++k) {
    const Signal& signal = signals[k];
    const auto [it, fresh] = place.try_emplace(chart_key(signal), charts.size());
    if (fresh) {
      text::LineChart chart;
      chart.id = "chart" + std::string(1, static_cast<char>('a' + charts.size() % 26)) +
                 std::string(charts.size() / 26, 'z');
      chart.x_label = "t, s";
      chart.y_label = signal.unit.empty() ? signal.name : signal.unit;
      charts.push_back(std::move(chart));
    }
    text::LineChart& chart = charts[it->second];
    chart.description += (chart.lines.empty() ? "Over time: " : ", ") + signal.name;
    chart.lines.push_back(
        {signal.name, fmt::format("s{}", chart.lines.size() % kStyles), points_of(pieces[k]), 1});
  }
  return charts;
}

std::string svg_document(const std::string& title, const std::vector<text::LineChart>& charts) {
  constexpr double kTop = 30;
  double y = kTop;
  std::string body;
  for (const text::LineChart& chart : charts) {
    const text::SvgChart drawn = text::draw_svg(chart);
    body += fmt::format("<svg y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\"{}", y, drawn.width,
                        drawn.height, drawn.text.substr(4));
    y += drawn.height + kGap;
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 960 {:.0f}\" width=\"960\" "
      "height=\"{:.0f}\">\n"
      "<style>{}</style>\n<text x=\"76\" y=\"20\" font-size=\"14\">{}</text>\n{}</svg>\n",
      y, y, kStyle, text::xml_text(title), body);
}

void write_svg(LogSamples& log, const std::string& title, const Sink& sink) {
  std::vector<std::vector<Envelope::Piece>> pieces;
  const std::vector<Signal> signals = log.chosen();
  for (const Envelope& envelope : read_envelopes(log, log.from_s(), kPieces))
    pieces.push_back(envelope.pieces());
  sink(svg_document(title, charts_of(signals, pieces)));
}

}  // namespace kadr::log_tools
