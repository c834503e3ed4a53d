#include "emulator/cycle/monitor/limit_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "machine/base/codes.h"
#include "machine/machine.h"

namespace kadr::cycle {
namespace {

/// Rounding of second differences over tau, relative to the limit watched.
constexpr double kRelativeSlack = 1e-6;

}  // namespace

struct LimitWatch::Word {
  Limit kind;
  Code code;
  const char* name;
  const char* per;  ///< behind mm or deg
};
const std::array<LimitWatch::Word, 4> LimitWatch::kWords = {{
    {Limit::position, Code::soft_limit_overrun, "position", ""},
    {Limit::speed, Code::speed_overrun, "speed", "/s"},
    {Limit::acceleration, Code::acceleration_overrun, "acceleration", "/s2"},
    {Limit::jerk, Code::jerk_overrun, "jerk", "/s3"},
}};

LimitWatch::LimitWatch(const machine::MachineModel& machine, const CommandedMotion& commanded,
                       EventList& events)
    : machine_(machine), commanded_(commanded), events_(events), overruns_(machine.axis.size()) {}

void LimitWatch::tick(Ticks end) {
  for (std::size_t a = 0; a < overruns_.size(); ++a)
    if (!commanded_[a].at_rest) watch_axis(a, end);
}

void LimitWatch::watch_axis(std::size_t axis, Ticks end) {
  const machine::AxisModel& model = machine_.axis[axis];
  const CommandedAxis& now = commanded_[axis];
  const double tau_s = machine_.clock.tau_s();
  const double corner_u_s2 = std::min(model.junction_accel_u_s2, model.junction_jerk_u_s3 * tau_s);
  watch_position(axis, now.position_u, end);
  watch(axis, Limit::speed, std::fabs(now.speed_u_s), model.max_feed_u_s, end);
  watch(axis, Limit::acceleration, std::fabs(now.accel_u_s2),
        model.max_accel_u_s2 + (commanded_.accel_spans_joint() ? corner_u_s2 : 0.0), end);
  if (model.max_jerk_u_s3 < machine::kInfinity)
    watch(axis, Limit::jerk, std::fabs(now.jerk_u_s3),
          model.max_jerk_u_s3 + (commanded_.jerk_spans_joint() ? 2 * corner_u_s2 / tau_s : 0.0), end);
}

void LimitWatch::watch_position(std::size_t axis, double position_u, Ticks end) {
  const machine::AxisModel& model = machine_.axis[axis];
  const bool over =
      position_u > model.soft_max_u + kSamePoint_u || position_u < model.soft_min_u - kSamePoint_u;
  watch(axis, Limit::position, over, position_u,
        position_u > model.soft_max_u ? model.soft_max_u : model.soft_min_u, end);
}

void LimitWatch::watch(std::size_t axis, Limit kind, double value, double limit, Ticks end) {
  watch(axis, kind, value > limit * (1 + kRelativeSlack), value, limit, end);
}

void LimitWatch::watch(std::size_t axis, Limit kind, bool over, double value, double limit, Ticks end) {
  Overrun& overrun = overruns_[axis][static_cast<std::size_t>(kind)];
  const auto sentence = [&](const char* verb) {
    const machine::AxisModel& model = machine_.axis[axis];
    const Word& word = kWords[static_cast<std::size_t>(kind)];
    return fmt::format("axis {} {} {} {:.6g} {}{}, allowed {:.6g}", model.letter, word.name, verb,
                       overrun.worst, model.kind == machine::AxisKind::rotary ? "deg" : "mm", word.per,
                       overrun.limit);
  };
  if (over && !overrun.open) {
    overrun = {true, value, limit};
    ++alarms_;
    tell(axis, kind, log::EventKind::alarm, overrun, end, sentence("is"));
  } else if (over) {
    const bool worse = std::fabs(value - limit) > std::fabs(overrun.worst - overrun.limit);
    if (worse) overrun.worst = value, overrun.limit = limit;
  } else if (overrun.open) {
    overrun.open = false;
    tell(axis, kind, log::EventKind::alarm_end, overrun, end, sentence("was at most"));
  }
}

void LimitWatch::tell(std::size_t axis, Limit kind, log::EventKind event, const Overrun& overrun, Ticks tick,
                      std::string text) {
  log::EventRecord& e = events_.add(tick, event);
  e.code = kWords[static_cast<std::size_t>(kind)].code;
  e.axis = static_cast<int>(axis);
  e.value = overrun.worst;
  e.limit = overrun.limit;
  e.text = std::move(text);
}

void LimitWatch::finish(Ticks end) {
  for (std::size_t a = 0; a < overruns_.size(); ++a)
    for (const Word& word : kWords) {
      Overrun& overrun = overruns_[a][static_cast<std::size_t>(word.kind)];
      if (!overrun.open) continue;
      overrun.open = false;
      tell(a, word.kind, log::EventKind::alarm_end, overrun, end,
           fmt::format("axis {} was still over its limit at the end, at most {:.6g}, allowed {:.6g}",
                       machine_.axis[a].letter, overrun.worst, overrun.limit));
    }
}

}  // namespace kadr::cycle
