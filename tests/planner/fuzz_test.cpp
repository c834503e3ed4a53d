#include <doctest/doctest.h>
#include <fmt/format.h>

#include "machine/machine.h"
#include "planner_support.h"

namespace kadr::test {

// Seed and count from KADR_SEED and KADR_COUNT; program number i is made from seed + i alone.
TEST_CASE("random programs on random machines break no limit and end exactly at their last position") {
  const std::uint64_t seed = environment("KADR_SEED", 1);
  const std::uint64_t count = environment("KADR_COUNT", 300);
  std::uint64_t segments = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    Random random(seed + i);
    const machine::MachineModel machine = random_machine(random);
    AxisValues end{};
    const planner::Path path = random_path(random, machine, end);
    segments += path.size();
    CAPTURE(seed + i);
    const auto plan = planner::plan(path, machine);
    REQUIRE_MESSAGE(plan, plan.error().diagnostic.message << ": " << plan.error().diagnostic.label);
    for (const planner::Violation& v : planner::verify(path, *plan, machine))
      FAIL_CHECK(fmt::format("seed {}: {} at {} s, segment {}, axis {}: {} (limit {})", seed + i, v.what,
                             v.time_s, v.segment, v.axis, v.value, v.limit));
    for (std::size_t j = 0; j < machine.axis.size(); ++j)
      CHECK(path.node(path.size())[j] == end[static_cast<std::size_t>(axis_index(machine.axis[j].letter))]);
    if (path.size() > 0) {
      std::vector<double> position(machine.axis.size());
      planner::eval_position(path, path.size() - 1, path.segments.back().length_u, position);
      for (std::size_t j = 0; j < position.size(); ++j) CHECK(position[j] == path.node(path.size())[j]);
    }
  }
  CHECK(segments > count);
}

}  // namespace kadr::test
