#include "gcode/interpret/interpreter.h"

#include <fmt/format.h>

#include <utility>

#include "gcode/interpret/macro_variables.h"

namespace kadr::gcode {

Interpreter::Interpreter(const InterpretOptions& options, Report& report, const Sink& sink)
    : options_(options),
      rules_(rules_of(options.dialect)),
      report_(report),
      sink_(sink),
      advice_(state_, options, report),
      owner_table_(options.codes, options.ignored),
      words_(options.dialect, owner_table_),
      compensation_([this](Block& block) { hand_out_compensated(block); }),
      passing_(options.from_line.has_value()),
      passed_(options.home) {
  state_.position = options.home;
  state_.inches = options.inches;
  units_pending_ = !options.units_said && !rules_.begins_in_mm;
  if (rules_.begins_with_rapid) state_.motion = state_.group_1 = Motion::traverse;
  state_.retract_to_start = rules_.begins_with_g98;
  if (rules_.rapid_at_feed_mm_min > 0) {
    state_.feed_linear_mm_min = state_.feed_rotary_deg_min = rules_.rapid_at_feed_mm_min;
    state_.feed_given = true;
  }
  state_.macros = rules_.macros;
  if (state_.macros.on) clear_macro_variables(state_);
  state_.parameters[parameter::kDebug] = 1;
  write_axis_parameters(state_, parameter::kG28, options.g28);
  write_axis_parameters(state_, parameter::kG30, options.g30);
  if (options.tools) state_.tools = *options.tools;
  for (const char letter : options.axis_letters) axes_on_machine_ |= letter_bit(letter);
  for (const WorkOffset& given : options.work_offsets) state_.set_work_zero(given.system, given.zero_u);
  state_.use_work_system(1);
  take_machine_values();
}

void Interpreter::run(const Line& line) {
  line_ = &line;
  if (line.items.empty()) return;
  if (options_.block_delete && line.items.front().kind == ItemKind::block_delete) return;
  bool readable = words_.read(line, state_, line.failed ? nullptr : &report_);
  if (words_.percent) {
    // the first % opens the program, the next one ends it; only comments may precede the first
    if (started_) finish(line_span(), true);
    if (!started_) opened_ = line_span();
    started_ = true;
    return;
  }
  started_ = started_ || words_.any;
  worded_ = worded_ || words_.any;
  if (line.failed) return recover(true);
  if (state_.diameter_mode || words_.g(GGroup::diameter) != kNoCode) take_diameters();
  if (options_.dialect != Dialect::linuxcnc) readable = take_dialect_words() && readable;
  if (!words_.owner_codes().empty()) take_owner_words();
  if (units_pending_) note_length();
  if (readable && plain_move()) return motion();
  if (!readable || !polar_words() || !check()) return recover(false);
  if (calls_only()) return call();
  if (compensation_.active()) return execute_compensated();
  execute();
}

/// True for a line of only axis words under G0 or G1. Most lines of most programs are like this; they skip
/// the checks and settings that can't apply to them.
bool Interpreter::plain_move() const {
  if (!words_.only_moves() || (words_.present & ~axes_on_machine_) != 0 || state_.uncertain.motion ||
      compensation_.active())
    return false;
  const Motion motion = motion_of_line();
  return motion == Motion::feed || motion == Motion::traverse;
}

void Interpreter::execute() {
  parameters();
  if (words_.comment >= 0) comment();
  if (!words_.any || ended_) return;
  spindle_mode();
  feed_mode();
  feed_rate();
  spindle_speed();
  select_tool();
  inputs_and_outputs();
  change_tool();
  spindle();
  modal_state();
  coolant();
  overrides();
  owner_codes();
  dwell();
  plane();
  units();
  diameter_mode();
  compensation();
  tool_length();
  work_system();
  path_control();
  distance_mode();
  retract_mode();
  nonmodal();
  motion();
  call();
  stop();
}

void Interpreter::apply_modes() {
  feed_mode();
  feed_rate();
  plane();
  units();
  compensation();
  work_system();
  distance_mode();
}

void Interpreter::recover(bool syntax) {
  silent_ = true;
  apply_modes();
  silent_ = false;
  const Motion before = state_.motion;
  Uncertain& uncertain = state_.uncertain;
  const bool cycles = motion_of_line() == Motion::cycle && moves();
  const int motion_code = words_.g(GGroup::motion);
  const bool for_this_line = motion_code == code::g5 || motion_code == code::g5_1;
  if (motion_code != kNoCode && !for_this_line) take_motion(motion_code);
  if (for_this_line) uncertain.motion = false;
  if (cycles) uncertain.cycle = true;
  if (nurbs_.open) nurbs_.faulty = true;
  if (words_.refused_motion || (syntax && words_.g(GGroup::motion) == kNoCode)) uncertain.motion = true;
  if (syntax) uncertain.feed = true;
  if (syntax || words_.has_axis() || (words_.present & letter_bits("IJK")) != 0) compensation_.lose();
  for (const Item& item : line_->items) {
    if (item.kind == ItemKind::setting || item.kind == ItemKind::unread) uncertain.parameters = true;
  }
  const int nonmodal_code = words_.g(GGroup::nonmodal);
  const bool plain_move =
      !uncertain.motion && nonmodal_code == kNoCode && (words_.has_axis() || state_.motion != before);
  if (syntax || nonmodal_code != kNoCode || words_.g(GGroup::g92_state) != kNoCode) {
    uncertain.axes = (1U << kProgramAxes) - 1;
  } else if (plain_move) {
    move_to(target());
  } else {
    for (int axis = 0; axis < kProgramAxes; ++axis) {
      if (words_.has(kAxisLetters[static_cast<std::size_t>(axis)])) uncertain.axes |= 1U << axis;
    }
  }
}

void Interpreter::lose_track() {
  Uncertain& uncertain = state_.uncertain;
  uncertain.axes = (1U << kProgramAxes) - 1;
  uncertain.feed = uncertain.motion = uncertain.parameters = uncertain.cycle = true;
  if (nurbs_.open) nurbs_.faulty = true;
  compensation_.lose();
}

void Interpreter::text_ran_out(std::uint32_t file) {
  if (ended_ || report_.errors() > 0) return;
  if (!worded_) {
    report_.warning(problem(Code::program_empty, {file, 1, 1, 1}, "no word stands in this program"));
  } else if (opened_.line > 0) {
    report_.warning(problem(Code::program_cut, opened_, "no second % and no M2 or M30 follows",
                            "end the program with M2 and %, or check that the file is whole"));
  }
}

void Interpreter::finish(Span end, bool by_percent) {
  if (ended_) return;
  if (nurbs_.open) drop_nurbs(end);
  emit(end, ProgramEnd{by_percent});
  ended_ = true;
  ended_by_percent_ = by_percent;
  tell_units();
}

void Interpreter::emit(Span span, Action action) {
  if (silent_ || ended_) return;
  Block block{span, std::move(action)};
  if (corner_ || corner_wish_) return emit_at_corner(std::move(block));
  pass_on(block);
}

void Interpreter::pass_on(Block& block) {
  if (!compensation_.active()) return hand_out(block);
  if (block_allowed(block.span, compensation_.waiting())) compensate(block);
}

void Interpreter::hand_out(Block& block) {
  if (ended_ || !block_allowed(block.span, 0)) return;
  if (place_) block.span = *place_;
  // how the program ends is not judged where it was cut off
  if (!is<ProgramEnd>(block) || !(left_ || passing_)) advice_.watch(block);
  if (passing_) return passed_.add(block);
  ++blocks_;
  sink_(block);
}

/// @param waiting  what is not handed out yet: blocks under compensation, points of a NURBS
bool Interpreter::block_allowed(Span span, std::size_t waiting) {
  const auto& bound = options_.bounds.blocks;
  const std::uint64_t per_line = runs_once_ ? ReadingBounds::kBlocksOfLine : 1;
  const std::uint64_t most = bound.value_or(ReadingBounds::kBlocks + per_line * text_lines_);
  if (most == 0 || blocks_ + waiting < most) return true;
  const std::string by_text =
      bound ? "" : fmt::format(", {} and {} for each line of the text", ReadingBounds::kBlocks, per_line);
  error(problem(Code::too_many_blocks, span, fmt::format("block {} would begin here", blocks_ + waiting + 1),
                fmt::format("allowed: {}{} (--limit blocks=N)", most, by_text)));
  ended_ = true;
  return false;
}

bool Interpreter::message_allowed(Span span, std::size_t bytes) {
  const std::uint64_t most = options_.bounds.messages;
  messages_ += weight_of(bytes);
  if (runs_once_ || most == 0 || messages_ <= most) return true;
  Diagnostic d = problem(Code::too_many_messages, span, fmt::format("message {} of the run", messages_));
  d.notes.push_back(fmt::format("allowed: {} (--limit messages=N)", most));
  error(std::move(d));
  ended_ = true;
  return false;
}

Span Interpreter::line_span() const {
  const auto& items = line_->items;
  return line_->span({items.front().bytes.begin, items.back().bytes.end});
}

bool Interpreter::error(Diagnostic d) {
  report_.error(std::move(d));
  return false;
}

}  // namespace kadr::gcode
