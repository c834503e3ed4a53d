// The parts of a long run that its page shows control tick by control tick.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "emulator/log_tools/report/page_data.h"

namespace kadr::log_tools {
namespace {

/// Stretches of at most that many control ticks together; overlaps count once.
class Chooser {
 public:
  Chooser(std::int64_t end, std::int64_t most) : end_(end), most_(most) {}

  /// @return false: there is no more room
  bool add(std::int64_t first, std::int64_t ticks) {
    Stretch fresh{std::clamp<std::int64_t>(first, 0, end_), 0};
    fresh.ticks = std::clamp<std::int64_t>(first + ticks, 0, end_) - fresh.first;
    if (fresh.ticks <= 0) return true;
    std::vector<Stretch> merged;
    std::int64_t total = 0;
    for (const Stretch& s : chosen_) {
      if (s.first + s.ticks < fresh.first || fresh.first + fresh.ticks < s.first) {
        merged.push_back(s);
        total += s.ticks;
        continue;
      }
      const std::int64_t end = std::max(s.first + s.ticks, fresh.first + fresh.ticks);
      fresh.first = std::min(s.first, fresh.first);
      fresh.ticks = end - fresh.first;
    }
    if (total + fresh.ticks > most_) return false;
    const auto at =
        std::find_if(merged.begin(), merged.end(), [&](const Stretch& s) { return s.first > fresh.first; });
    merged.insert(at, fresh);
    chosen_ = std::move(merged);
    return true;
  }
  std::vector<Stretch> take() { return std::move(chosen_); }

 private:
  std::int64_t end_, most_;
  std::vector<Stretch> chosen_;
};

/// Piece in which a signal is farthest from zero; none: it has no values.
std::optional<std::size_t> worst_piece(const Track& track) {
  std::optional<std::size_t> out;
  float worst = -1;
  for (std::size_t i = 0; i < track.low.size(); ++i) {
    const float value = std::max(std::abs(track.low[i]), std::abs(track.high[i]));
    if (!(value > worst)) continue;
    worst = value;
    out = i;
  }
  return out;
}

}  // namespace

std::vector<Stretch> stretches_of_interest(const PageData& data, std::int64_t most) {
  const std::int64_t ticks_s =
      std::max<std::int64_t>(1, data.header.base_hz / data.header.control_tick_ticks);
  Chooser chooser(static_cast<std::int64_t>(data.pieces()) * data.every, most);
  const auto round_tick = [&](Ticks tick) {
    return tick.value < 0 ||
           chooser.add(tick.value / data.header.control_tick_ticks - data.first_control_tick - ticks_s / 2,
                       ticks_s);
  };
  for (const log::EventRecord& e : data.events)
    if (e.kind == log::EventKind::alarm && !round_tick(e.tick)) return chooser.take();
  for (const log::LogDiagnostic& d : data.diagnostics)
    if (d.severity != Severity::note && !round_tick(d.tick)) return chooser.take();
  for (const Track& track : data.tracks) {
    const auto piece = worst_piece(track);
    if (!piece) continue;
    const std::int64_t length = std::max(ticks_s, data.every);
    const std::int64_t middle = static_cast<std::int64_t>(*piece) * data.every + data.every / 2;
    if (!chooser.add(middle - length / 2, length)) return chooser.take();
  }
  for (const log::EventRecord& e : data.events)
    if (e.kind != log::EventKind::alarm && !round_tick(e.tick)) return chooser.take();
  return chooser.take();
}

tl::expected<FullRate, log::LogReadError> read_full_rate(const std::string& path, const SampleChoice& choice,
                                                         const PageData& data,
                                                         const std::vector<Stretch>& stretches) {
  auto log = LogSamples::open(path);
  if (!log) return tl::unexpected(log.error());
  std::vector<std::string> names;
  for (const Track& track : data.tracks) names.push_back(track.signal.name);
  log->choose(choice, names);
  FullRate out;
  out.stretches = stretches;
  out.tracks.resize(data.tracks.size());
  out.nodes.resize(data.nodes.size());
  std::size_t total = 0;
  for (const Stretch& s : stretches) total += static_cast<std::size_t>(s.ticks);
  for (auto& values : out.tracks) values.assign(total, std::numeric_limits<float>::quiet_NaN());
  for (auto& nodes : out.nodes) nodes.assign(total, 0);
  // control ticks that the log skips are at rest: no value, the last node
  std::vector<std::int32_t> now(data.nodes.size(), 0);
  std::size_t stretch = 0, begin = 0, filled = 0;
  const auto fill_to = [&](std::size_t end) {
    for (; filled < end; ++filled)
      for (std::size_t a = 0; a < now.size(); ++a) out.nodes[a][filled] = now[a];
  };
  Sample sample;
  while (stretch < stretches.size() && log->next(sample)) {
    const std::int64_t tick = sample.control_tick - data.first_control_tick;
    while (stretch < stretches.size() && tick >= stretches[stretch].first + stretches[stretch].ticks) {
      begin += static_cast<std::size_t>(stretches[stretch].ticks);
      fill_to(begin);
      ++stretch;
    }
    const bool inside = stretch < stretches.size() && tick >= stretches[stretch].first;
    const std::size_t at = inside ? begin + static_cast<std::size_t>(tick - stretches[stretch].first) : 0;
    if (inside) fill_to(at);
    for (std::size_t a = 0; a < now.size(); ++a)
      now[a] = static_cast<std::int32_t>(std::clamp<std::int64_t>(
          sample.frame->ticks->axis[a].steps[sample.frame->tick_index], INT32_MIN, INT32_MAX));
    if (!inside) continue;
    fill_to(at + 1);
    for (std::size_t k = 0; k < out.tracks.size(); ++k) out.tracks[k][at] = narrowed(sample.value[k]);
  }
  fill_to(total);
  return out;
}

}  // namespace kadr::log_tools
