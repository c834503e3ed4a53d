#include "emulator/log_tools/report/path_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "emulator/text/line_chart.h"
#include "emulator/text/text.h"

namespace kadr::log_tools {
namespace {

// pixels of the drawing
constexpr double kWidth = 960, kLeft = 76, kRight = 26, kTop = 32, kBelow = 46;
constexpr double kMostAcross = kWidth - kLeft - kRight, kMostDown = 480, kLeast = 120, kTick = 90;
constexpr double kMargin = 0.04;             ///< of the larger extent, on all sides
constexpr std::size_t kCornersDrawn = 2000;  ///< about 20 kB

/// A linear axis of the picture.
struct Side {
  std::size_t axis = 0;  ///< of the machine
  std::string name;
  double step_mm = 0;
  const std::vector<std::int32_t>* nodes = nullptr;  ///< [corners]
  text::ChartRange mm{};
  bool moves() const { return mm.high > mm.low; }
  double at(std::size_t corner) const { return step_mm * (*nodes)[corner]; }
};

/// The two axes of the picture, the one across first; none: there are not two linear axes.
std::optional<std::array<Side, 2>> sides_of(const log::LogHeader& header, const PathCorners& corners) {
  std::vector<Side> linear;
  const std::vector<double> steps_mm = picture_steps_mm(header);
  for (std::size_t a = 0; a < steps_mm.size(); ++a) {
    if (steps_mm[a] == 0) continue;
    const auto [low, high] = std::minmax_element(corners.nodes[a].begin(), corners.nodes[a].end());
    linear.push_back(
        {a, header.axis[a].name, steps_mm[a], &corners.nodes[a], {steps_mm[a] * *low, steps_mm[a] * *high}});
  }
  if (linear.size() < 2) return {};
  std::stable_partition(linear.begin(), linear.end(), [](const Side& side) { return side.moves(); });
  // in the order of the machine's axes; on a lathe Z lies across
  if (linear[0].axis > linear[1].axis) std::swap(linear[0], linear[1]);
  if (linear[0].name == "X" && linear[1].name == "Z") std::swap(linear[0], linear[1]);
  return std::array{linear[0], linear[1]};
}

/// Whether the line that leads to each corner is a rapid: half-way, since a corner lies a little behind the
/// end of its block.
std::vector<bool> rapids(const PageData& data, const PathCorners& corners) {
  std::vector<bool> out(corners.size(), false);
  std::size_t begun = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::int64_t before = i > 0 ? corners.ticks[i - 1] : 0;
    const std::int64_t control_tick = data.first_control_tick + (before + corners.ticks[i]) / 2;
    while (begun < data.blocks.size() &&
           data.blocks[begun].begin.value <= control_tick * data.header.control_tick_ticks)
      ++begun;
    const std::string_view motion = begun > 0 ? std::string_view(data.blocks[begun - 1].motion) : "";
    out[i] = motion == "rapid" || motion == log::kApproachMotion;
  }
  return out;
}

class Picture {
 public:
  explicit Picture(std::array<Side, 2> sides) : sides_(std::move(sides)) {
    std::array<double, 2> extent_mm{};
    for (int k = 0; k < 2; ++k) extent_mm[k] = sides_[k].mm.high - sides_[k].mm.low;
    const double margin_mm = std::max(kMargin * std::max(extent_mm[0], extent_mm[1]), 1e-3);
    for (double& extent : extent_mm) extent += 2 * margin_mm;
    scale_ = std::min(kMostAcross / extent_mm[0], kMostDown / extent_mm[1]);
    for (int k = 0; k < 2; ++k) {
      // a path along one axis is drawn in a band, not on the frame
      const double half_mm = std::max(extent_mm[k], kLeast / scale_) / 2;
      const double middle_mm = (sides_[k].mm.low + sides_[k].mm.high) / 2;
      shown_[k] = {middle_mm - half_mm, middle_mm + half_mm};
    }
  }

  double width() const { return scale_ * (shown_[0].high - shown_[0].low); }
  double height() const { return scale_ * (shown_[1].high - shown_[1].low); }
  double across(double mm) const { return kLeft + scale_ * (mm - shown_[0].low); }
  double down(double mm) const { return kTop + scale_ * (shown_[1].high - mm); }
  const Side& side(int k) const { return sides_[k]; }

  std::string axes() const {
    std::string out;
    const double right = kLeft + width(), bottom = kTop + height();
    const std::array<double, 2> pixels = {width(), height()};
    for (int k = 0; k < 2; ++k) {
      const std::vector<double> ticks =
          text::nice_ticks(shown_[k], std::max(2, static_cast<int>(pixels[k] / kTick)));
      const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
      for (const double mm : ticks)
        out += k == 0 ? fmt::format(
                            "<path class=\"grid\" d=\"M{0:.1f} {1:.1f}V{2:.1f}\"/>"
                            "<text class=\"x\" x=\"{0:.1f}\" y=\"{3:.1f}\">{4}</text>\n",
                            across(mm), kTop, bottom, bottom + 17, text::tick_text(mm, step))
                      : fmt::format(
                            "<path class=\"grid\" d=\"M{0:.1f} {1:.1f}H{2:.1f}\"/>"
                            "<text class=\"y\" x=\"{3:.1f}\" y=\"{4:.1f}\">{5}</text>\n",
                            kLeft, down(mm), right, kLeft - 8, down(mm) + 4, text::tick_text(mm, step));
    }
    out += fmt::format("<path class=\"frame\" d=\"M{0:.1f} {1:.1f}V{2:.1f}H{3:.1f}\"/>\n", kLeft, kTop,
                       bottom, right);
    out += fmt::format("<text class=\"x name\" x=\"{:.1f}\" y=\"{:.1f}\">{}, mm</text>\n",
                       kLeft + width() / 2, bottom + 38, text::xml_text(sides_[0].name));
    return out + fmt::format(
                     "<text class=\"x name\" transform=\"translate(14,{:.1f}) rotate(-90)\">{}, mm</text>\n",
                     kTop + height() / 2, text::xml_text(sides_[1].name));
  }

 private:
  std::array<Side, 2> sides_;
  std::array<text::ChartRange, 2> shown_;
  double scale_ = 1;  // pixels per mm
};

constexpr std::string_view kLegend =
    "<g transform=\"translate(76,14)\"><path class=\"line s0\" d=\"M0 0H26\"/><text x=\"34\" "
    "y=\"4\">feed</text></g>\n"
    "<g transform=\"translate(156,14)\"><path class=\"line s1\" d=\"M0 0H26\"/><text x=\"34\" "
    "y=\"4\">rapid</text></g>\n";

}  // namespace

std::string path_svg(const PageData& data) {
  if (data.corners.size() < 2) return {};
  double tolerance_mm = kChord_mm;
  const PathCorners corners =
      thinned(data.corners, picture_steps_mm(data.header), tolerance_mm, kCornersDrawn);
  const auto sides = sides_of(data.header, corners);
  if (!sides) return {};
  const Picture picture(*sides);
  const auto point = [&](std::size_t i) {
    return fmt::format("{:.1f} {:.1f}", picture.across(picture.side(0).at(i)),
                       picture.down(picture.side(1).at(i)));
  };
  const std::vector<bool> rapid = rapids(data, corners);
  // a corner belongs to the line that leads to it
  std::array<std::string, 2> lines;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const bool begins = i == 1 || rapid[i] != rapid[i - 1];
    lines[rapid[i] ? 1 : 0] += (begins ? "M" + point(i - 1) : "") + "L" + point(i);
  }
  std::string out = fmt::format(
      "<svg viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-labelledby=\"path_d\">\n"
      "<desc id=\"path_d\">Tool path as commanded, {} over {}</desc>\n",
      kWidth, kTop + picture.height() + kBelow, text::xml_text(picture.side(1).name),
      text::xml_text(picture.side(0).name));
  out += kLegend;
  out += picture.axes();
  for (int k = 1; k >= 0; --k)
    if (!lines[k].empty()) out += fmt::format("<path class=\"line s{}\" d=\"{}\"/>\n", k, lines[k]);
  return out + "</svg>\n";
}

}  // namespace kadr::log_tools
