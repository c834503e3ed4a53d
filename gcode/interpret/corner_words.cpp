#include <fmt/format.h>

#include <utility>

#include "gcode/interpret/interpreter.h"

/// ,R and ,C of Fanuc: a move with one of them waits for the next, and what comes between them waits behind it.
namespace kadr::gcode {

/// Takes ,R or ,C off the line.
void Interpreter::take_corner_word() {
  corner_wish_.reset();
  for (const char letter : {kCornerRadius, kCornerChamfer}) {
    if (!words_.has(letter)) continue;
    const double size_mm = words_.value(letter) * state_.length_factor();
    const CornerWish wish{letter == kCornerRadius, size_mm, words_.span(*line_, letter)};
    words_.remove(letter);
    const Motion motion = motion_of_line();
    const bool cuts = moves() && (motion == Motion::feed || is_arc(motion));
    if (!cuts) {
      refuse_corner(wish.span, "no G1, G2 or G3 moves on this line");
    } else if (corner_wish_) {
      refuse_corner(wish.span, "a second corner on this line");
    } else if (!(size_mm >= 0) || state_.feed_mode == FeedMode::inverse_time ||
               (state_.rotation_deg != 0 && plane_of_line() != Plane::xy)) {
      refuse_corner(wish.span,
                    size_mm < 0 ? "a size below 0" : "kadr makes no corner under G93 or in a tilted plane");
    } else if (size_mm > 0) {
      corner_wish_ = wish;
    }
  }
  if (words_.g(GGroup::compensation) == kNoCode) return;
  if (corner_) refuse_corner(corner_->wish.span, "G40, G41 or G42 follows");
  release_corner();
}

void Interpreter::refuse_corner(Span span, std::string label) {
  error(problem(Code::corner_place, span, std::move(label)));
}

/// A block between a move with ,R or ,C and the next one, or such a move itself.
void Interpreter::emit_at_corner(Block block) {
  const bool cuts = is<Feed, Arc>(block);
  if (corner_ && !cuts) {
    if (!is_move(block) && !is<ProgramEnd>(block)) {
      if (block_allowed(block.span, corner_->behind.size())) corner_->behind.push_back(std::move(block));
      return;
    }
    refuse_corner(corner_->wish.span, "no G1, G2 or G3 follows");
    release_corner();
  }
  AxisValues start = move_from_;
  if (corner_) start = join_at_corner(block);
  if (!corner_wish_ || !cuts) return pass_on(block);
  corner_ = WaitingCorner{*corner_wish_, std::move(block), start, state_.plane, {}};
  corner_wish_.reset();
}

/// Hands out the waiting move and the corner; `second` begins behind it.
/// @return where it begins
AxisValues Interpreter::join_at_corner(Block& second) {
  CornerMoves made;
  const AxisValues programmed = move_of(corner_->move)->end;
  const CornerFault fault =
      make_corner(corner_->wish, corner_->plane, corner_->start, corner_->move, second, made);
  const auto refuse = [&](std::string_view label) { refuse_corner(corner_->wish.span, std::string(label)); };
  switch (fault) {
    case CornerFault::none: {
      pass_on(made.first);
      pass_on(made.corner);
      for (Block& block : corner_->behind) pass_on(block);
      corner_.reset();
      second = std::move(made.second);
      return made.corner_end;
    }
    case CornerFault::too_large:
      refuse("it takes more of a move than there is");
      break;
    case CornerFault::other_axis:
      refuse("a move beside it leaves the plane");
      break;
    case CornerFault::chamfer_arc:
      refuse("a chamfer at an arc: kadr cuts corners of straight moves");
      break;
    case CornerFault::straight:
      break;  // nothing to round
  }
  release_corner();
  return programmed;
}

/// Hands out what waits, as it is.
void Interpreter::release_corner() {
  if (!corner_) return;
  WaitingCorner waiting = std::move(*corner_);
  corner_.reset();
  pass_on(waiting.move);
  for (Block& block : waiting.behind) pass_on(block);
}

}  // namespace kadr::gcode
