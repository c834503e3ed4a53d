#include "emulator/teach/pulses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kadr::emulator {
namespace {

// two edges of a pulse and one of DIR need ticks of their own
constexpr std::int64_t kLeastSpacing_ticks = 4;

/// A change of a wire, in the order of time and then of writing.
struct Edge {
  std::int64_t at;
  int order;  ///< falls before DIR before rises, where they meet
  char wire;
  bool high;
};

std::int64_t least_spacing(const PulseTrain& train) {
  std::int64_t least = INT64_MAX;
  for (const auto& pulses : train.axis)
    for (std::size_t i = 1; i < pulses.size(); ++i)
      least = std::min(least, (pulses[i].at - pulses[i - 1].at).value);
  return least;
}

char wire_of(std::size_t axis, bool dir) { return static_cast<char>('a' + 2 * static_cast<int>(axis) + dir); }

}  // namespace

char axis_letter(std::size_t axis) { return "XYZABCUVW"[axis]; }

Spacing spacing_of(const std::vector<TeachPulse>& pulses) {
  Spacing out;
  for (std::size_t i = 1; i < pulses.size(); ++i) {
    if (pulses[i].sign != pulses[i - 1].sign) continue;
    const std::int64_t apart = (pulses[i].at - pulses[i - 1].at).value;
    out.least_ticks = out.most_ticks == 0 ? apart : std::min(out.least_ticks, apart);
    out.most_ticks = std::max(out.most_ticks, apart);
  }
  return out;
}

tl::expected<PulseTrain, std::string> pulse_train(const StepTable& table, PulseTiming timing,
                                                  double feed_steps_s, std::int64_t clock_hz) {
  if (timing == PulseTiming::crossing && table.crossings_steps.size() != table.rows.size())
    return tl::unexpected(
        fmt::format("--timing crossing goes with half_step and crossing, whose pulses are crossings; got {}",
                    lattice::entry_of(table.method).name));
  PulseTrain train;
  train.clock_hz = clock_hz;
  train.axis.resize(static_cast<std::size_t>(table.axes));
  const double step_ticks = static_cast<double>(clock_hz) / feed_steps_s;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double place =
        timing == PulseTiming::uniform ? static_cast<double>(i + 1) : table.crossings_steps[i];
    const Ticks at{std::llround(place * step_ticks)};
    for (std::size_t k = 0; k < train.axis.size(); ++k)
      if (table.rows[i].slot.step[k] != 0) train.axis[k].push_back({at, table.rows[i].slot.step[k]});
  }
  const double places =
      timing == PulseTiming::uniform ? static_cast<double>(table.rows.size() + 1) : table.length_steps;
  train.duration = Ticks{std::llround(places * step_ticks)};
  if (const std::int64_t least = least_spacing(train); least < kLeastSpacing_ticks)
    return tl::unexpected(
        fmt::format("pulses of one axis are {} ticks of {} Hz apart, at least {} are needed; a lower --feed "
                    "spreads them",
                    least, clock_hz, kLeastSpacing_ticks));
  return train;
}

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
  const std::int64_t high = std::min(high_ticks, least_spacing(train) / 2);
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

}  // namespace kadr::emulator
