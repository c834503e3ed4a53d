#include <fmt/format.h>

#include <algorithm>

#include "emulator/studies/teach/pulses.h"

namespace kadr::studies {
namespace {

/// A change of a wire, in the order of time and then of writing.
struct Edge {
  std::int64_t at;
  int order;  ///< at one moment: falls, then DIR, then rises
  char wire;
  bool high;
};

char wire_of(std::size_t axis, bool dir) { return static_cast<char>('a' + 2 * static_cast<int>(axis) + dir); }

}  // namespace

std::string render_vcd(const PulseTrain& train, std::int64_t high_ticks) {
  const std::int64_t tick_ns = 1'000'000'000 / train.clock_hz;
  std::string out = fmt::format(
      "$comment kadr teach: STEP rises where an axis steps, DIR 1 is the positive "
      "direction $end\n$timescale {} ns $end\n$scope module axes $end\n",
      tick_ns);
  for (std::size_t k = 0; k < train.axis.size(); ++k)
    out += fmt::format("$var wire 1 {0} STEP_{2} $end\n$var wire 1 {1} DIR_{2} $end\n", wire_of(k, false),
                       wire_of(k, true), axis_letter(k));
  out += "$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n";
  const std::int64_t high = std::min(high_ticks, least_spacing_ticks(train) / 2);
  std::vector<Edge> edges;
  for (std::size_t k = 0; k < train.axis.size(); ++k) {
    const auto& pulses = train.axis[k];
    int sign = pulses.empty() ? 1 : pulses.front().sign;
    out += fmt::format("0{}\n{}{}\n", wire_of(k, false), sign > 0 ? 1 : 0, wire_of(k, true));
    std::int64_t fallen = 0;
    for (const TeachPulse& p : pulses) {
      // halfway between the last fall and this rise
      if (p.sign != sign)
        edges.push_back({fallen + (p.at.value - fallen) / 2, 1, wire_of(k, true), p.sign > 0});
      sign = p.sign;
      fallen = p.at.value + high;
      edges.push_back({p.at.value, 2, wire_of(k, false), true});
      edges.push_back({fallen, 0, wire_of(k, false), false});
    }
  }
  out += "$end\n";
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.at != b.at ? a.at < b.at : a.order < b.order;
  });
  std::int64_t now = 0;
  for (const Edge& e : edges) {
    if (e.at != now) out += fmt::format("#{}\n", e.at);
    now = e.at;
    out += fmt::format("{}{}\n", e.high ? 1 : 0, e.wire);
  }
  if (train.duration.value > now) out += fmt::format("#{}\n", train.duration.value);
  return out;
}

}  // namespace kadr::studies
