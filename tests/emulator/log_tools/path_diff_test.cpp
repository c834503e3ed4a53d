#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "diff_support.h"
#include "emulator/log_tools/diff/diff_report.h"
#include "machine/machine.h"

using namespace kadr;
using namespace kadr::log_tools;
using kadr::test::PathRun;
using kadr::test::TestFolder;
using kadr::test::write_path_log;

namespace {

/// A run at 50 mm/s next to another one.
struct Pair {
  TestFolder folder;
  machine::MachineModel machine_a = test::log_machine(3), machine_b = machine_a;
  std::string a = folder / "a.lcmlog", b = folder / "b.lcmlog";
  PathDiff of(const PathRun& other, const DiffOptions& options = {}) {
    write_path_log(a, machine_a, {});
    write_path_log(b, machine_b, other);
    auto diff = diff_paths(a, b, options);
    REQUIRE(diff.has_value());
    return std::move(*diff);
  }
};

DiffOptions steps_only() {
  DiffOptions options;
  REQUIRE(add_ignored(options, "feed").has_value());
  return options;
}

/// As an override that is turned, halted and turned again.
PathRun other_timing() {
  PathRun run;
  run.rest_ticks = 37;
  run.feed_mm_s = [](double s_mm) { return 31.7 + 9 * std::floor(s_mm * 1.3); };
  return run;
}

}  // namespace

TEST_CASE("runs under other feeds have the same step sequence in every block") {
  Pair pair;
  const PathDiff diff = pair.of(other_timing(), steps_only());
  CHECK(!diff.differ());
  CHECK(diff.blocks == 10);
  CHECK(diff.path_a_u == 10.0);
  CHECK(diff.path_b_u == 10.0);
}

TEST_CASE("another clock does not matter to a comparison by path") {
  Pair pair;
  pair.machine_b.clock.base_hz = 20'000'000;
  pair.machine_b.clock.control_tick = Ticks{9000};
  const PathDiff diff = pair.of(other_timing(), steps_only());
  CHECK(!diff.differ());
  CHECK(diff.inputs_differ());
  CHECK(!pair.of({}, steps_only()).differ());
}

TEST_CASE("two pulses in the other order are found in their block") {
  // Y's pulse 1200 stands at s = 2.401 mm, in block 2, between X's pulses 2400 (2.4005) and 2401 (2.4015 mm)
  Pair pair;
  PathRun swapped = other_timing();
  swapped.place = [](int axis, std::int64_t pulse, double s_mm) {
    return axis == 1 && pulse == 1200 ? s_mm + 0.0008 : s_mm;
  };
  const PathDiff diff = pair.of(swapped, steps_only());
  CHECK(diff.blocks == 10);
  CHECK(diff.blocks_differing == 1);
  REQUIRE(diff.first_block);
  CHECK(diff.first_block->a.block == 2);
  CHECK(diff.first_block->counts.empty());
  // counted within the block: X has 2401 - 2000 = 401 pulses before, Y 1200 - 1000 = 200
  CHECK(diff.first_block->order.find("pulse 201 of Y") != std::string::npos);
  CHECK(diff.first_block->order.find("pulse 402 of ") != std::string::npos);
}

TEST_CASE("a pulse moved without passing another one is no difference of the sequence") {
  Pair pair;
  PathRun moved = other_timing();
  moved.place = [](int axis, std::int64_t pulse, double s_mm) {
    return axis == 1 && pulse == 1200 ? s_mm + 0.0003 : s_mm;
  };
  CHECK(!pair.of(moved, steps_only()).differ());
}

TEST_CASE("a missing pulse is counted in its block, and the blocks behind it are still compared") {
  Pair pair;
  PathRun other = other_timing();
  other.drops = [](int axis, std::int64_t pulse) { return axis == 0 && (pulse == 4500 || pulse == 7300); };
  const PathDiff diff = pair.of(other, steps_only());
  CHECK(diff.blocks == 10);
  CHECK(diff.blocks_differing == 2);
  REQUIRE(diff.first_block);
  CHECK(diff.first_block->a.block == 4);
  REQUIRE(diff.first_block->counts.size() == 1);
  CHECK(diff.first_block->counts[0].axis == "X");
  // the pulse of the lattice node on the block's border belongs to either side
  CHECK(diff.first_block->counts[0].a == 1000);
  CHECK(diff.first_block->counts[0].b == 999);
}

TEST_CASE("a pulse with the other direction is found in its block") {
  Pair pair;
  PathRun other = other_timing();
  other.flips = [](int axis, std::int64_t pulse) { return axis == 2 && pulse == 9100; };
  const PathDiff diff = pair.of(other, steps_only());
  CHECK(diff.blocks_differing == 1);
  REQUIRE(diff.first_block);
  CHECK(diff.first_block->a.block == 9);
  CHECK(diff.first_block->order == "pulse 101 of Z has the other direction: +1 | -1");
}

TEST_CASE("feeds are told to part where they part on the path, whenever that is") {
  Pair pair;
  PathRun other;
  other.rest_ticks = 500;
  other.feed_mm_s = [](double s_mm) { return s_mm > 3 && s_mm < 5 ? 25.0 : 50.0; };
  const PathDiff diff = pair.of(other);
  CHECK(diff.differ());
  CHECK(diff.blocks_differing == 0);
  CHECK(diff.spans == 1);
  REQUIRE(diff.first_span);
  // a control tick at 50 mm/s is 0.05 mm
  CHECK(diff.first_span->from_u == doctest::Approx(3.0).epsilon(0.04));
  CHECK(diff.first_span->to_u == doctest::Approx(5.0).epsilon(0.02));
  CHECK(diff.first_span->largest_u_s == doctest::Approx(25.0));
  REQUIRE(diff.first_span->a.block);
  CHECK(diff.first_span->a.block->block == 3);
  DiffOptions tolerant;
  REQUIRE(add_tolerance(tolerant.tolerance, "feed=26mm/s").has_value());
  CHECK(!pair.of(other, tolerant).differ());
}

TEST_CASE("a run that ends early on the path is compared as far as it goes") {
  Pair pair;
  PathRun shorter = other_timing();
  shorter.end_mm = 6.4;
  const PathDiff diff = pair.of(shorter, steps_only());
  CHECK(diff.differ());
  CHECK(diff.paths_differ());
  CHECK(diff.blocks_differing == 0);
  CHECK(diff.blocks == 6);
}

TEST_CASE("a log without KADR_TICKS has no path to align by") {
  Pair pair;
  pair.machine_b.log.ticks = false;
  write_path_log(pair.a, pair.machine_a, {});
  write_path_log(pair.b, pair.machine_b, {});
  const auto diff = diff_paths(pair.a, pair.b, {});
  REQUIRE(!diff.has_value());
  CHECK(diff.error().path == pair.b);
}
