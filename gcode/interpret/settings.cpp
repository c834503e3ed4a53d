#include <fmt/format.h>

#include "gcode/interpret/interpreter.h"
#include "gcode/interpret/message.h"
#include "machine/base/parse_number.h"

namespace kadr::gcode {
namespace {

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

void Interpreter::parameters() {
  for (const Words::Setting& setting : words_.settings) {
    if (setting.name >= 0) {
      set_named(state_, setting.name, setting.value);
    } else if (state_.macros.on) {
      set_macro_variable(setting.number, setting.value, line_span());
    } else {
      const auto number = static_cast<std::size_t>(setting.number);
      state_.parameters[number] = setting.value;
      state_.parameters_set[number] = true;
    }
  }
}

void Interpreter::comment() {
  const Item& item = line_->items[static_cast<std::size_t>(words_.comment)];
  const ActiveComment active = active_comment(line_->slice(item.bytes));
  worded_ = worded_ || !active.command.empty();
  if (same_letters(active.command, "TECH")) return technology(active.text, line_->span(item.bytes));
  if (same_letters(active.command, "ABORT"))
    return abort_program(expanded_text(active.text, state_, line_->number), line_->span(item.bytes));
  const bool message = same_letters(active.command, "MSG");
  const bool debug = same_letters(active.command, "DEBUG");
  if (!message && !debug && !same_letters(active.command, "PRINT")) return;
  if (debug && state_.parameters[parameter::kDebug] == 0) return;
  const Span span = line_->span(item.bytes);
  std::string text = message ? valid_text(active.text) : expanded_text(active.text, state_, line_->number);
  if (!message_allowed(span, text.size())) return;
  if (message) return emit(span, Message{std::move(text)});
  if (debug) return emit(span, Message{text});
  emit(span, Comment{text});
}

/// (ABORT, text): nothing behind it is run.
void Interpreter::abort_program(std::string text, Span span) {
  error(problem(Code::program_aborts, span,
                "the program comes here and stops: " + std::string(without_blanks(text))));
  ended_ = true;
}

/// (TECH s_max=200): a technological limit of speed at this position.
void Interpreter::technology(std::string_view text, Span span) {
  constexpr double kFastest_mm_s = 1e6;
  const std::size_t equals = text.find('=');
  const std::string_view name = without_blanks(text.substr(0, equals)),
                         value = without_blanks(text.substr(equals + 1));
  const std::optional<double> speed = parse_number(value);
  if (same_letters(name, "S_MAX") && speed && *speed > 0 && *speed <= kFastest_mm_s) {
    return emit(span, SpeedPoint{*speed});
  }
  const bool known = same_letters(name, "S_MAX");
  report_.error(problem(
      Code::technology_comment, span,
      known ? fmt::format("s_max is {}, allowed above 0 to {:.0f} mm/s", valid_text(value), kFastest_mm_s)
            : fmt::format("{} is not known", valid_text(name)),
      "write (TECH s_max=200): at most 200 mm/s where the next move begins"));
}

void Interpreter::feed_mode() {
  const int code = words_.g(GGroup::feed_mode);
  if (code == kNoCode) return;
  const Span span = g_span(GGroup::feed_mode);
  state_.feed_mode = code == code::g93   ? FeedMode::inverse_time
                     : code == code::g94 ? FeedMode::units_per_minute
                                         : FeedMode::units_per_revolution;
  emit(span, SetFeedMode{state_.feed_mode});
  if (state_.feed_mode == FeedMode::inverse_time) return;
  // G94 and G95 always begin without a feed, even if they were in force already
  emit(span, SetFeedRate{});
  state_.feed_cleared = state_.feed_cleared || state_.feed_given;
  state_.feed_given = false;
  state_.feed_linear_mm_min = state_.feed_rotary_deg_min = 0;
  state_.feed_linear_mm_rev = state_.feed_rotary_deg_rev = 0;
  state_.feed_number = 0;
}

void Interpreter::feed_rate() {
  if (!words_.has('F')) return;
  const double f = words_.value('F');
  const Span span = words_.span(*line_, 'F');
  SetFeedRate feed{f};
  const bool inverse = state_.feed_mode == FeedMode::inverse_time;
  if (!inverse) {
    state_.feed_number = f;
    const bool per_minute = state_.feed_mode == FeedMode::units_per_minute;
    feed.rate = f * state_.length_factor();
    (per_minute ? state_.feed_linear_mm_min : state_.feed_linear_mm_rev) = feed.rate;
    (per_minute ? state_.feed_rotary_deg_min : state_.feed_rotary_deg_rev) = f;
    state_.feed_given = true;
    state_.feed_cleared = false;
    state_.uncertain.feed = (words_.doubtful & letter_bit('F')) != 0;
  }
  emit(span, feed);
  const int units_code = words_.g(GGroup::units);
  const bool changes_units = units_code != kNoCode && (units_code == code::g20) != state_.inches;
  if (changes_units && !inverse && !silent_) {
    report_.warning(problem(Code::feed_before_units, span,
                            fmt::format("taken as {} per {}", state_.inches ? "inches" : "mm",
                                        state_.feed_mode == FeedMode::units_per_minute ? "minute" : "turn"),
                            fmt::format("write {} on a line before F", g_name(units_code))));
  }
}

Plane Interpreter::plane_of_line() const {
  const int code = words_.g(GGroup::plane);
  for (const Plane plane : {Plane::xy, Plane::zx, Plane::yz})
    if (code == plane_code(plane)) return plane;
  return state_.plane;
}

void Interpreter::plane() { state_.plane = plane_of_line(); }

void Interpreter::units() {
  const int code = words_.g(GGroup::units);
  if (code == kNoCode) return;
  state_.inches = code == code::g20;
  units_pending_ = false;
  if (length_.line > 0 && units_later_.empty())
    units_later_ = fmt::format("{} follows on line {}", g_name(code), g_span(GGroup::units).line);
}

void Interpreter::work_system() {
  const int code = words_.g(GGroup::coordinate_system);
  if (code == kNoCode) return;
  // G54 .. G59 are 1 .. 6, G59.1 .. G59.3 are 7 .. 9, G54.1 P1 is 10
  int further = 0;
  if (code == code::g54_1) near_integer(words_.value('P'), further);
  const int system = code == code::g54_1 ? kWorkSystems + further
                     : code <= code::g59 ? 1 + (code - code::g54) / 10
                                         : 6 + (code - code::g59);
  // as RS-274/NGC: parameters that a program has set take effect with the change to their system
  if (system != state_.work_system) state_.use_work_system(system);
}

void Interpreter::path_control() {
  const int code = words_.g(GGroup::path);
  if (code == kNoCode) return;
  warn_without_effect();
  const double tolerance = code == code::g64 && words_.has('P') ? words_.value('P') : 0;
  set_path_mode(code == code::g61     ? PathMode::exact_path
                : code == code::g61_1 ? PathMode::exact_stop
                                      : PathMode::continuous,
                tolerance, g_span(GGroup::path));
}

void Interpreter::set_path_mode(PathMode mode, double tolerance, Span span) {
  state_.path_mode = mode;
  state_.path_tolerance = tolerance;
  state_.path_tolerance_mm = tolerance * state_.length_factor();
  emit(span, SetPathMode{mode, state_.path_tolerance_mm});
}

void Interpreter::distance_mode() {
  const int distance = words_.g(GGroup::distance);
  if (distance != kNoCode) state_.incremental = distance == code::g91;
  const int arc_distance = words_.g(GGroup::arc_distance);
  if (arc_distance != kNoCode) state_.arc_centers_absolute = arc_distance == code::g90_1;
}

}  // namespace kadr::gcode
