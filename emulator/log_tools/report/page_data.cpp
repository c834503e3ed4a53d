#include "emulator/log_tools/report/page_data.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "machine/machine_file.h"

namespace kadr::log_tools {
namespace {

/// The page's signals, as far as the log has them; further ones are added (Signal::further).
constexpr const char* kSignals[] = {
    "feed.commanded*",    "feed.programmed*",     "feed.override_used*", "feed.override_requested*",
    "feed.acceleration*", "feed.jerk*",           "feed.limited_by",     "path.error*",
    "axis.*.speed*",      "axis.*.acceleration*", "axis.*.jerk*",        "axis.*.following*",
    "axis.*.vibration*",  "axis.*.step_rate*",
};

constexpr const char* kPath = "path.length*";  // the last one: not a track

std::vector<std::string> wanted(const LogSamples& log) {
  std::vector<std::string> out;
  const auto add = [&](const char* pattern) {
    for (const Signal& signal : log.signals())
      if (matches_pattern(signal.name, pattern)) out.push_back(signal.name);
  };
  for (const char* pattern : kSignals) add(pattern);
  for (const Signal& signal : log.signals())
    if (signal.further) out.push_back(signal.name);
  add(kPath);
  return out;
}

/// The settings of the log are a machine file, followed by the options of the run.
std::optional<machine::MachineModel> machine_of(const log::LogHeader& header) {
  SourceSet sources;
  const std::string text = header.settings_toml.substr(0, header.settings_toml.find("[run]\n"));
  auto file = machine::read_machine(SourceText("settings", text), sources);
  if (!file || file->model.axis.size() != header.axis.size()) return std::nullopt;
  return std::move(file->model);
}

std::int32_t count32(double value) {
  return static_cast<std::int32_t>(std::clamp(value, double{INT32_MIN}, double{INT32_MAX}));
}

float lower(float a, float b) { return std::isnan(a) ? b : std::isnan(b) ? a : std::min(a, b); }
float higher(float a, float b) { return std::isnan(a) ? b : std::isnan(b) ? a : std::max(a, b); }

class Gatherer {
 public:
  explicit Gatherer(PageData& data)
      : data_(data), corners_(picture_steps_mm(data.header), kChord_mm, kMostCorners) {}

  void frame(const LogFrame& frame) {
    for (const LogItem& item : frame.items) std::visit(*this, item);
  }

  void operator()(const log::BlockRecord& b) {
    if (data_.blocks.size() >= kMostBlocks) {
      ++data_.blocks_left_out;
      return;
    }
    data_.blocks.push_back({b.tick, b.block, b.span.line, b.length_u, b.planned_s, b.programmed_u_s,
                            b.planned_peak_u_s, b.limited_by, b.motion, b.text});
  }
  void operator()(const log::EventRecord& e) {
    if (e.kind == log::EventKind::alarm ? alarms_++ < kMostEvents : data_.events.size() < kMostEvents)
      data_.events.push_back(e);
    else
      ++data_.events_left_out;
  }
  void operator()(const log::LogDiagnostic& d) {
    if (data_.diagnostics.size() < kMostEvents) data_.diagnostics.push_back(d);
  }

  void sample(const Sample& s) {
    const log::TickBlock& ticks = *s.frame->ticks;
    const std::size_t i = s.frame->tick_index;
    if (data_.control_ticks++ == 0) data_.first_control_tick = s.control_tick;
    const auto piece = static_cast<std::size_t>((s.control_tick - data_.first_control_tick) / data_.every);
    if (piece >= most_pieces()) {
      halve(data_);
      --data_.control_ticks;
      return sample(s);
    }
    // control ticks that the log skips are at rest: their pieces hold the last node and no value
    while (data_.pieces() <= piece) grow();
    for (std::size_t k = 0; k < data_.tracks.size(); ++k) {
      const float value = narrowed(s.value[k]);
      data_.tracks[k].low[piece] = lower(data_.tracks[k].low[piece], value);
      data_.tracks[k].high[piece] = higher(data_.tracks[k].high[piece], value);
    }
    data_.path_milli[piece] = count32(std::round(1000 * s.value.back()));
    nodes_.resize(data_.nodes.size());
    for (std::size_t a = 0; a < data_.nodes.size(); ++a)
      nodes_[a] = data_.nodes[a][piece] = count32(static_cast<double>(ticks.axis[a].steps[i]));
    corners_.add(count32(static_cast<double>(s.control_tick - data_.first_control_tick)), nodes_);
    if (ticks.has_plant) work(ticks, i);
  }

  PathCorners corners() const { return corners_.corners(); }

 private:
  /// Control ticks that a log skips take pieces too: a log of a few ticks that are far apart gets few.
  std::size_t most_pieces() const {
    constexpr std::size_t kForEachTick = 4096;
    return std::min(kMostPieces, kForEachTick * static_cast<std::size_t>(data_.control_ticks));
  }

  void grow() {
    for (Track& track : data_.tracks) {
      track.low.push_back(std::numeric_limits<float>::quiet_NaN());
      track.high.push_back(std::numeric_limits<float>::quiet_NaN());
    }
    for (auto& nodes : data_.nodes) nodes.push_back(nodes.empty() ? 0 : nodes.back());
    data_.path_milli.push_back(data_.path_milli.empty() ? 0 : data_.path_milli.back());
  }

  void work(const log::TickBlock& ticks, std::size_t i) {
    data_.work.resize(ticks.axis.size());
    const double tau_s = data_.header.seconds(Ticks{data_.header.control_tick_ticks});
    for (std::size_t a = 0; a < ticks.axis.size(); ++a) {
      if (!data_.header.axis[a].has_plant) continue;
      const bool rotary = data_.header.axis[a].unit == "deg";
      const double speed = ticks.axis[a].base_u_s[i] * (rotary ? 3.14159265358979323846 / 180 : 1e-3);
      const double energy_J = ticks.axis[a].motor_force_N[i] * speed * tau_s;
      (energy_J > 0 ? data_.work[a].driving_J : data_.work[a].braking_J) += energy_J;
    }
  }

  PageData& data_;
  CornerFinder corners_;
  std::vector<std::int32_t> nodes_;  // after the control tick at hand
  std::size_t alarms_ = 0;
};

}  // namespace

float narrowed(double value) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return static_cast<float>(std::isnan(value) ? value : std::clamp(value, -kMost, kMost));
}

std::vector<double> picture_steps_mm(const log::LogHeader& header) {
  std::vector<double> out;
  for (const log::LogAxis& axis : header.axis) out.push_back(axis.unit == "mm" ? axis.step_u : 0);
  return out;
}

void halve(PageData& data) {
  const std::size_t n = data.pieces();
  for (Track& track : data.tracks) {
    for (std::size_t i = 0; i < n; i += 2) {
      const std::size_t j = std::min(i + 1, n - 1);
      track.low[i / 2] = lower(track.low[i], track.low[j]);
      track.high[i / 2] = higher(track.high[i], track.high[j]);
    }
    track.low.resize((n + 1) / 2);
    track.high.resize((n + 1) / 2);
  }
  const auto last = [n](std::vector<std::int32_t>& values) {
    for (std::size_t i = 0; i < n; i += 2) values[i / 2] = values[std::min(i + 1, n - 1)];
    values.resize((n + 1) / 2);
  };
  for (auto& nodes : data.nodes) last(nodes);
  last(data.path_milli);
  data.every *= 2;
}

tl::expected<PageData, log::LogReadError> read_page_data(const std::string& path,
                                                         const SampleChoice& choice) {
  auto log = LogSamples::open(path);
  if (!log) return tl::unexpected(log.error());
  log->choose(choice, wanted(*log));
  PageData data;
  data.header = log->header();
  data.machine = machine_of(data.header);
  for (const Signal& signal : log->chosen())
    if (!matches_pattern(signal.name, kPath)) data.tracks.push_back({signal, {}, {}});
  data.nodes.resize(data.header.axis.size());
  Gatherer gather(data);
  log->watch([&](const LogFrame& frame) { gather.frame(frame); });
  for (Sample sample; log->next(sample);) gather.sample(sample);
  data.corners = gather.corners();
  data.end = *log->end();
  data.summary = log->summary();
  return data;
}

}  // namespace kadr::log_tools
