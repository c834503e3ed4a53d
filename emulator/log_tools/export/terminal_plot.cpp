#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "emulator/log_tools/export/charts.h"
#include "emulator/log_tools/export/export.h"
#include "emulator/text/text.h"

namespace kadr::log_tools {
namespace {

constexpr int kMargin = 11;  ///< cells of the axis' numbers
constexpr int kRows = 10, kPathRows = 20;
constexpr int kLeastRows = 3;
constexpr double kNoDigit = 1e-4;  ///< part of a range that its numbers of four digits can't show

/// Dots in cells of 2 x 4 Braille dots, or one a cell.
class Canvas {
 public:
  Canvas(int columns, int rows, bool ascii)
      : across_(ascii ? 1 : 2),
        down_(ascii ? 1 : 4),
        columns_(columns),
        rows_(rows),
        ascii_(ascii),
        cells_(static_cast<std::size_t>(columns * rows)) {}

  int width() const { return columns_ * across_; }
  int height() const { return rows_ * down_; }

  /// y from 0 at the bottom; outside the picture nothing is drawn.
  void dot(int x, int y) {
    if (x < 0 || y < 0 || x >= width() || y >= height()) return;
    y = height() - 1 - y;
    static constexpr int kBits[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    cells_[static_cast<std::size_t>(y / down_ * columns_ + x / across_)] |= kBits[y % down_][x % across_];
  }
  void upright(int x, int y0, int y1) {
    for (int y = std::min(y0, y1); y <= std::max(y0, y1); ++y) dot(x, y);
  }
  void line(int x0, int y0, int x1, int y1) {
    const int n = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
    for (int i = 0; i <= n; ++i)
      dot(x0 + (n == 0 ? 0 : (x1 - x0) * i / n), y0 + (n == 0 ? 0 : (y1 - y0) * i / n));
  }

  /// A row of cells without trailing blanks.
  std::string row(int r) const {
    std::string out;
    std::size_t end = 0;
    for (int c = 0; c < columns_; ++c) {
      const int dots = cells_[static_cast<std::size_t>(r * columns_ + c)];
      if (dots == 0) {
        out += ' ';
        continue;
      }
      if (ascii_) {
        out += '#';
      } else {
        // U+2800 and the dots, in UTF-8
        out += '\xE2';
        out += static_cast<char>(0xA0 | (dots >> 6));
        out += static_cast<char>(0x80 | (dots & 63));
      }
      end = out.size();
    }
    out.resize(end);
    return out;
  }

 private:
  int across_, down_, columns_, rows_;
  bool ascii_;
  std::vector<int> cells_;
};

/// Half the distance from `from` to `to`. The whole one of two finite numbers need not be finite.
double half_way(double from, double to) { return 0.5 * to - 0.5 * from; }

/// Where a value lies in a range: 0 at its low end, 1 at its high one.
double share_of(double value, const text::ChartRange& range) {
  const double width = half_way(range.low, range.high);
  return width > 0 ? std::clamp(half_way(range.low, value) / width, 0.0, 1.0) : 0;
}

/// Rows of a picture with numbers to the left of the first, middle and last one.
std::string framed(const Canvas& canvas, int rows, const text::ChartRange& y) {
  std::string out;
  for (int r = 0; r < rows; ++r) {
    const double value = r == 0 ? y.high
                         : r == rows - 1
                             ? y.low
                             : 2 * (0.5 * y.low + half_way(y.low, y.high) * (rows - 1 - r) / (rows - 1));
    const bool labelled = r == 0 || r == rows - 1 || 2 * r == rows - 1;
    out += text::pad_left(labelled ? text::significant(value) : "", kMargin - 2) + (labelled ? " ┤" : " │") +
           canvas.row(r);
    while (!out.empty() && out.back() == ' ') out.pop_back();
    out += '\n';
  }
  return out;
}

std::string footing(const std::string& left, const std::string& right, int width) {
  const std::size_t inner = static_cast<std::size_t>(width - kMargin);
  const std::size_t used = text::display_width(left) + text::display_width(right);
  return std::string(kMargin, ' ') + left + std::string(used < inner ? inner - used : 1, ' ') + right + '\n';
}

/// An end of a range that is zero except for rounding, compared with the other end.
text::ChartRange without_dust(text::ChartRange range) {
  const double least = 2 * kNoDigit * half_way(range.low, range.high);
  if (std::fabs(range.low) < least) range.low = 0;
  if (std::fabs(range.high) < least) range.high = 0;
  return range;
}

text::ChartRange not_empty(text::ChartRange range) {
  if (!(range.high > range.low)) {
    const double half = range.low == 0 ? 1 : std::fabs(range.low) * 0.1;
    range = {range.low - half, range.high + half};
  }
  return range;
}

std::string picture(const Signal& signal, const std::vector<Envelope::Piece>& pieces, const PlotForm& form) {
  text::ChartRange y{0, 0}, t{0, 0};
  bool first = true;
  for (const Envelope::Piece& p : pieces) {
    if (p.empty) continue;
    y = first ? text::ChartRange{p.low, p.high}
              : text::ChartRange{std::min(y.low, p.low), std::max(y.high, p.high)};
    t = {first ? p.begin_s : t.low, p.end_s};
    first = false;
  }
  const std::string unit = signal.unit.empty() ? "" : " " + signal.unit;
  if (first) return signal.name + "   nothing to draw\n";
  y = without_dust(y);
  std::string out = fmt::format("{}   {} .. {}{}\n", signal.name, text::significant(y.low),
                                text::significant(y.high), unit);
  y = not_empty(y);
  const int rows = form.height > 0 ? form.height : kRows;
  Canvas canvas(form.width - kMargin, rows, form.ascii);
  const auto down = [&](double value) {
    return static_cast<int>(std::floor(share_of(value, y) * (canvas.height() - 1) + 0.5));
  };
  int last_column = -1, last_low = 0, last_high = 0;
  for (const Envelope::Piece& p : pieces) {
    if (p.empty) continue;
    const double middle = 0.5 * (p.begin_s + p.end_s);
    const int x = std::min(canvas.width() - 1, static_cast<int>(share_of(middle, t) * canvas.width()));
    int low = down(p.low), high = down(p.high);
    // neighbours touch
    if (last_column >= 0 && x - last_column <= 1) {
      if (low > last_high) low = last_high;
      if (high < last_low) high = last_low;
    }
    canvas.upright(x, low, high);
    // between columns a straight line, where there are fewer pieces than columns
    if (last_column >= 0 && x - last_column > 1) canvas.line(last_column, last_high, x, down(p.high));
    last_column = x;
    last_low = down(p.low);
    last_high = down(p.high);
  }
  return out + framed(canvas, rows, y) +
         footing(fmt::format("{} s", text::fixed(t.low, 3)), fmt::format("{} s", text::fixed(t.high, 3)),
                 form.width);
}

}  // namespace

std::string render_plot(LogSamples& log, const PlotForm& form) {
  const std::vector<Signal> signals = log.chosen();
  // four pieces a dot column: a column's own lowest and highest value
  std::size_t most = 8;
  while (most < static_cast<std::size_t>(8 * form.width)) most *= 2;
  std::string out;
  const std::vector<Envelope> envelopes = read_envelopes(log, log.from_s(), most);
  for (std::size_t k = 0; k < signals.size(); ++k)
    out += (k == 0 ? "" : "\n") + picture(signals[k], envelopes[k].pieces(), form);
  return out;
}

std::string render_path_plot(LogSamples& log, const PlotForm& form) {
  const log::LogHeader& header = log.header();
  std::vector<std::size_t> axes;
  for (std::size_t a = 0; a < header.axis.size() && axes.size() < 2; ++a)
    if (header.axis[a].unit == "mm") axes.push_back(a);
  if (axes.size() < 2) return "no two linear axes to draw a path of\n";
  const auto place = [&](const Sample& sample, std::size_t k) {
    return sample.frame->ticks->axis[axes[k]].command_u[sample.frame->tick_index];
  };
  // nodes of a fine grid that the path visits would need the size first: every place, thinned as it grows
  constexpr std::size_t kMost = 200'000;
  std::vector<std::array<double, 2>> points;
  std::size_t every = 1, count = 0;
  for (Sample sample; log.next(sample); ++count) {
    if (count % every != 0) continue;
    points.push_back({place(sample, 0), place(sample, 1)});
    if (points.size() < kMost) continue;
    for (std::size_t i = 0; 2 * i < points.size(); ++i) points[i] = points[2 * i];
    points.resize(points.size() / 2);
    every *= 2;
  }
  if (points.empty()) return "nothing to draw\n";
  text::ChartRange x{points[0][0], points[0][0]}, y{points[0][1], points[0][1]};
  for (const auto& p : points) {
    x = {std::min(x.low, p[0]), std::max(x.high, p[0])};
    y = {std::min(y.low, p[1]), std::max(y.high, p[1])};
  }
  std::string out = fmt::format("path in {0} and {1}   {0} {2} .. {3} mm, {1} {4} .. {5} mm\n",
                                header.axis[axes[0]].name, header.axis[axes[1]].name, text::fixed(x.low, 3),
                                text::fixed(x.high, 3), text::fixed(y.low, 3), text::fixed(y.high, 3));
  // a terminal's cell is twice as high as wide: a Braille dot is square, an ASCII cell is not
  const double tall = form.ascii ? 2 : 1;
  const int columns = form.width - kMargin, most_rows = form.height > 0 ? form.height : kPathRows;
  const Canvas room(columns, most_rows, form.ascii);
  constexpr double kLeast_mm = 1e-9;
  // dots for half a millimetre
  const double scale =
      std::min((room.width() - 1) / std::max(half_way(x.low, x.high), kLeast_mm / 2),
               (room.height() - 1) * tall / std::max(half_way(y.low, y.high), kLeast_mm / 2));
  // no more rows than the path fills
  const int dots = static_cast<int>(half_way(y.low, y.high) * scale / tall + 0.5) + 1,
            down = room.height() / most_rows;
  const int rows = std::clamp((dots + down - 1) / down, std::min(kLeastRows, most_rows), most_rows);
  Canvas canvas(columns, rows, form.ascii);
  int px = 0, py = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int cx = static_cast<int>(half_way(x.low, points[i][0]) * scale + 0.5);
    const int cy = static_cast<int>(half_way(y.low, points[i][1]) * scale / tall + 0.5);
    canvas.line(i == 0 ? cx : px, i == 0 ? cy : py, cx, cy);
    px = cx;
    py = cy;
  }
  const text::ChartRange shown = without_dust({y.low, y.low + 2 * (canvas.height() - 1) * tall / scale});
  return out + framed(canvas, rows, shown) +
         footing(fmt::format("{} mm", text::fixed(x.low, 3)),
                 fmt::format("{} mm", text::fixed(x.low + 2 * (canvas.width() - 1) / scale, 3)), form.width);
}

}  // namespace kadr::log_tools
