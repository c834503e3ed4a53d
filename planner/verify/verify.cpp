#include "planner/verify/verify.h"

#include <algorithm>

#include "machine/infinity.h"
#include "planner/verify/verify_context.h"
#include "planner/verify/verify_pauses.h"

namespace kadr::planner {
namespace {

/// The whole path, or the windows of it that the options say.
void verify_windows(VerifyContext& c) {
  const std::size_t size = c.path.size();
  if (size <= c.options.whole_up_to) return verify_limits(c, 0, size);
  for (std::size_t i = 0; i < size && !c.full(); i += c.options.stride)
    verify_limits(c, i, std::min(i + c.options.window, size));
  verify_limits(c, size - std::min(c.options.window, size), size);
}

void verify_all(VerifyContext& c) {
  if (c.path.size() == 0) {
    if (!c.law.pieces.empty() && c.pauses.empty())
      c.report("law without path", 0.0, 0, -1, c.law.duration_s, 0.0);
    return verify_pauses(c);
  }
  if (c.law.pieces.empty()) return c.report("path without law", 0.0, 0, -1, 0.0, c.path.length_u());
  verify_law_ends(c);
  verify_law_links(c);
  verify_windows(c);
  verify_stops(c);
  verify_table(c);
  verify_pauses(c);
  if (!c.full() && c.plan.segments.size() == c.path.size()) verify_blocks(c);
}

}  // namespace

VerifyOptions production_check() {
  VerifyOptions options;
  options.sample_s = machine::kInfinity;
  options.most = 1;
  options.parts = 4;
  options.quadrants = 8;
  options.chords = 16;
  options.curves_that_turn_back = false;
  options.whole_up_to = 64;
  options.window = 16;
  options.stride = 256;
  return options;
}

std::vector<Violation> verify(const Path& path, const FeedPlan& plan, const machine::MachineModel& machine,
                              const VerifyOptions& options, std::span<const Pause> pauses) {
  return verify(*machine_joints(path, machine), plan, machine, options, pauses);
}

std::vector<Violation> verify(const Joints& joints, const FeedPlan& plan,
                              const machine::MachineModel& machine, const VerifyOptions& options,
                              std::span<const Pause> pauses) {
  VerifyContext context(joints, plan, machine, options, pauses);
  verify_all(context);
  return std::move(context.found);
}

}  // namespace kadr::planner
