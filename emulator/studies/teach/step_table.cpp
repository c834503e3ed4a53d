#include "emulator/studies/teach/step_table.h"

#include <fmt/format.h>

namespace kadr::studies {
namespace {

namespace lattice = interpolator::lattice;

using lattice::Curve;
using lattice::Method;
using lattice::Refusal;

std::string refusal_text(Refusal refusal, const Curve& curve, Method method, std::string_view kind) {
  const auto name = lattice::entry_of(method).name();
  switch (refusal) {
    case Refusal::no_length:
      return fmt::format("{}: nothing to follow: both ends are the same node", kind);
    case Refusal::range:
      return fmt::format("{}: a coordinate is beyond what {} counts in integers, {} steps", kind, name,
                         lattice::most_steps(curve));
    case Refusal::off_curve:
      return fmt::format("{}: the end is more than 0.707 steps off the circle through the start", kind);
    case Refusal::one_quadrant:
      return fmt::format("{}: {} stays within the quadrant of its start; the end is in another one", kind,
                         name);
    case Refusal::in_line:
      return fmt::format(
          "{}: the control points are collinear, so this is not a conic; use --method crossing", kind);
    case Refusal::none:
    case Refusal::other_curve:
      break;
  }
  std::string known;
  for (const lattice::MethodEntry& m : lattice::methods())
    if (lattice::knows(m.method, curve)) known += fmt::format("{}{}", known.empty() ? "" : ", ", m.name());
  return fmt::format("{} is not followed by {}; methods for it: {}", kind, name, known);
}

}  // namespace

tl::expected<StepTable, std::string> step_table(const TeachCase& subject, Method method,
                                                const TeachOptions& options) {
  Followed followed = follow(subject, method, options);
  if (followed.refusal != Refusal::none)
    return tl::unexpected(refusal_text(followed.refusal, subject.legs[followed.leg], followed.table.method,
                                       kCaseKinds.word(subject.kind)));
  if (!followed.complete)
    return tl::unexpected(fmt::format(
        "{}: no end after {} slots, allowed {} (--most); it is longer, or folds inside a cell, where a "
        "sign can't follow it",
        kCaseKinds.word(subject.kind), options.most_slots, options.most_slots));
  return std::move(followed.table);
}

}  // namespace kadr::studies
