#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gcode/constants.h"
#include "gcode/interpret/interpreter.h"
#include "machine/base/numbers.h"

namespace kadr::gcode {
namespace {

constexpr double kMillimetresPerMetre = 1000.0;
constexpr double kMetresPerFoot = 0.3048;
/// G96 without D: at X0 the speed would be infinite. No spindle turns faster than this.
constexpr double kFastestSpindle_rpm = 100'000.0;

/// Mean of max(slope · |x|, floor) for x from a to b.
double mean_of_bent_line(double a, double b, double slope, double floor) {
  if (a > b) std::swap(a, b);
  if (!(b > a)) return std::max(slope * std::fabs(a), floor);
  // areas of the flat part and of the slopes to both sides: only sums, so that near ends lose no digits
  const double bend = slope > 0 ? floor / slope : std::fmax(std::fabs(a), std::fabs(b));
  const double left = std::clamp(-bend, a, b), right = std::clamp(bend, a, b);
  const double area = slope * (left - a) * std::fabs(left + a) / 2 + floor * (right - left) +
                      slope * (b - right) * (b + right) / 2;
  return std::max(area / (b - a), floor);
}

}  // namespace

void Interpreter::spindle_mode() {
  const int code = words_.g(GGroup::spindle_mode);
  if (code == kNoCode) return;
  const Span span = g_span(GGroup::spindle_mode);
  const double maximum_rpm = words_.has('D') ? std::fabs(words_.value('D')) : 0;
  state_.constant_surface_speed = code == code::g96;
  // D0 is the controller's form of G97
  state_.surface = {.on = code == code::g96 && !(words_.has('D') && maximum_rpm == 0),
                    .speed_m_min = 0,
                    .maximum_rpm = maximum_rpm};
  if (state_.surface.on) state_.surface.speed_m_min = surface_speed_m_min();
  emit(span, SpindleMode{state_.surface.speed_m_min, state_.surface.maximum_rpm});
}

double Interpreter::surface_speed_m_min() const {
  return words_.value('S') * (state_.inches ? kMetresPerFoot : 1.0);
}

void Interpreter::spindle_speed() {
  if (!words_.has('S')) return;
  state_.spindle_rpm = words_.value('S');
  if (state_.surface.on) state_.surface.speed_m_min = surface_speed_m_min();
  emit(words_.span(*line_, 'S'), SpindleSpeed{state_.spindle_rpm, state_.surface.speed_m_min});
}

/// The constant speed at which the spindle would make as many turns during a straight move of constant feed
/// per turn: under G96 the speed is S · 1000 / (2 pi |x|), at most D, so turns per mm follow |x|.
double Interpreter::mean_spindle_rpm(const AxisValues& from, const AxisValues& to) const {
  if (state_.turning == Turning::stopped) return 0;
  if (!state_.surface.on) return state_.spindle_rpm;
  const SurfaceSpeed& surface = state_.surface;
  if (!(surface.speed_m_min > 0)) return 0;
  const double minutes_per_turn_mm = 2 * kPi / (surface.speed_m_min * kMillimetresPerMetre);
  const double fastest_rpm =
      surface.maximum_rpm > 0 ? std::min(surface.maximum_rpm, kFastestSpindle_rpm) : kFastestSpindle_rpm;
  return 1 / mean_of_bent_line(state_.to_program(from)[0], state_.to_program(to)[0], minutes_per_turn_mm,
                               1 / fastest_rpm);
}

bool Interpreter::feed_per_turn_ready() {
  if (state_.feed_mode != FeedMode::units_per_revolution) return true;
  // LinuxCNC requires a speed only before lines and arcs
  const Motion motion = motion_of_line();
  const bool asked = motion == Motion::feed || is_arc(motion) || motion == Motion::probe;
  if (state_.spindle_rpm == 0 && asked) {
    if (state_.uncertain.feed) return false;
    state_.uncertain.feed = true;
    return error(problem(Code::feed_without_speed, action_span(), "the spindle's speed here is S0",
                         "write S and M3 before the first feed move under G95"));
  }
  warn_standing_spindle();
  return true;
}

void Interpreter::warn_standing_spindle() {
  const bool stands = state_.turning == Turning::stopped;
  if (standing_told_ || (!stands && state_.spindle_rpm > 0)) return;
  standing_told_ = true;
  report_.warning(problem(Code::feed_of_standing_spindle, action_span(),
                          stands ? "the spindle is not turning here" : "the spindle turns at S0 here",
                          "write S and M3 or M4 before it"));
}

void Interpreter::follow_spindle(Move& move) {
  const bool rotary = move.feed_length == FeedLength::rotary;
  if (threading_) {
    move.pitch_u_rev = rotary ? thread_pitch_u_rev_ : thread_pitch_u_rev_ * state_.length_factor();
  } else {
    move.pitch_u_rev = rotary ? state_.feed_rotary_deg_rev : state_.feed_linear_mm_rev;
  }
  const double turns_s = mean_spindle_rpm(state_.position, move.end) / kSecondsPerMinute;
  move.feed_u_s = std::max(0.0, move.pitch_u_rev) * turns_s;
}

}  // namespace kadr::gcode
