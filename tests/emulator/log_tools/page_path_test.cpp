#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "emulator/log_tools/report/page_data.h"
#include "emulator/log_tools/report/path_corners.h"
#include "planner/path/path.h"

using namespace kadr::log;
using namespace kadr::log_tools;
using kadr::Ticks;

namespace {

using Path = std::vector<std::vector<std::int32_t>>;  // [control ticks][axes]

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

CornerFinder found(const Path& path, const std::vector<double>& step_mm, double tolerance_mm,
                   std::size_t most = kAll) {
  CornerFinder finder(step_mm, tolerance_mm, most);
  for (std::size_t i = 0; i < path.size(); ++i) finder.add(static_cast<std::int32_t>(i), path[i]);
  return finder;
}

/// Largest distance of a node from the corners' line over its control ticks, by sampling that line finely: no
/// formula of the code under test.
double farthest_mm(const Path& path, const PathCorners& corners, const std::vector<double>& step_mm) {
  double worst = 0;
  for (std::size_t c = 1; c < corners.size(); ++c)
    for (auto i = static_cast<std::size_t>(corners.ticks[c - 1]);
         i <= static_cast<std::size_t>(corners.ticks[c]); ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (int k = 0; k <= 4000; ++k) {
        double sum = 0;
        for (std::size_t a = 0; a < step_mm.size(); ++a) {
          const double from = corners.nodes[a][c - 1], to = corners.nodes[a][c];
          const double off = step_mm[a] * (from + (to - from) * k / 4000 - path[i][a]);
          sum += off * off;
        }
        nearest = std::min(nearest, sum);
      }
      worst = std::max(worst, std::sqrt(nearest));
    }
  return worst;
}

/// A circle of 20 mm radius at 50 mm/s in steps of 1 um, one control tick of 1 ms a node.
Path circle(std::size_t ticks) {
  Path path;
  for (std::size_t i = 0; i < ticks; ++i) {
    const double angle = 0.050 / 20 * static_cast<double>(i);
    path.push_back({static_cast<std::int32_t>(std::lround(20'000 * std::cos(angle))),
                    static_cast<std::int32_t>(std::lround(20'000 * std::sin(angle)))});
  }
  return path;
}

}  // namespace

TEST_CASE("corners of a path: its ends, its turns, and nothing on a straight way shorter than 64 nodes") {
  // 30 nodes to the right, 30 back on the same line, 30 upward
  Path path;
  for (int i = 0; i <= 30; ++i) path.push_back({10 * i, 0, 7});
  for (int i = 1; i <= 30; ++i) path.push_back({300 - 10 * i, 0, 7});
  for (int i = 1; i <= 30; ++i) path.push_back({0, 10 * i, 7});
  const PathCorners corners = found(path, {0.001, 0.001, 0}, 0.0005).corners();
  CHECK(corners.ticks == std::vector<std::int32_t>{0, 30, 60, 90});
  CHECK(corners.nodes[0] == std::vector<std::int32_t>{0, 300, 0, 0});
  CHECK(corners.nodes[1] == std::vector<std::int32_t>{0, 0, 0, 300});
  CHECK(corners.nodes[2] == std::vector<std::int32_t>{7, 7, 7, 7});
}

TEST_CASE("corners of a circle keep its chord; a chord of 5 um at 20 mm is 0.9 mm or 18 control ticks long") {
  // sagitta h = c^2 / (8 R): c = sqrt(8 * 20 * 0.005) = 0.894 mm; the lattice of 1 um takes a little of it
  const Path path = circle(1000);
  const CornerFinder finder = found(path, {0.001, 0.001}, 0.005);
  const PathCorners corners = finder.corners();
  CHECK(farthest_mm(path, corners, {0.001, 0.001}) <= 0.005 + 1e-6);
  CHECK(corners.size() > 1000 / 19);
  CHECK(corners.size() < 1000 / 14);
  // the check works: with half the corners the chord is four times as high
  PathCorners fewer{{}, {{}, {}}};
  for (std::size_t i = 0; i < corners.size(); i += 2) {
    fewer.ticks.push_back(corners.ticks[i]);
    for (std::size_t a = 0; a < 2; ++a) fewer.nodes[a].push_back(corners.nodes[a][i]);
  }
  CHECK(farthest_mm(path, fewer, {0.001, 0.001}) > 0.010);
}

TEST_CASE("standing still is one stretch: corners where it begins and where it ends") {
  Path path;
  for (int i = 0; i <= 10; ++i) path.push_back({100 * i});
  for (int i = 0; i < 500; ++i) path.push_back({1000});
  for (int i = 1; i <= 10; ++i) path.push_back({1000 + 100 * i});
  const PathCorners corners = found(path, {0.001}, 0.005).corners();
  CHECK(corners.nodes[0].front() == 0);
  CHECK(corners.nodes[0].back() == 2000);
  CHECK(corners.size() < 20);
}

TEST_CASE("too many corners double the tolerance, and the line stays within twice of it") {
  const Path path = circle(4000);
  const CornerFinder finder = found(path, {0.001, 0.001}, 0.0001, 100);
  CHECK(finder.corners().size() <= 101);
  CHECK(finder.tolerance_mm() > 0.0001);
  CHECK(farthest_mm(path, finder.corners(), {0.001, 0.001}) <= 2 * finder.tolerance_mm());
  double tolerance_mm = 0.005;
  const PathCorners few = thinned(finder.corners(), {0.001, 0.001}, tolerance_mm, 10);
  CHECK(few.size() <= 10);
  CHECK(few.ticks.front() == 0);
  CHECK(few.ticks.back() == 3999);
}

TEST_CASE(
    "full rate goes round alarms and warnings, then round each signal's largest value, then round other "
    "events") {
  // 100 s at 1 ms in pieces of 4 control ticks; a spike of -9 in piece 10 000 (40 s) of a signal
  PageData data;
  data.header.base_hz = 10'000'000;
  data.header.control_tick_ticks = 10'000;
  data.every = 4;
  std::vector<float> low(25'000, 0), high(25'000, 1);
  low[10'000] = -9;
  data.tracks.push_back({{"a", "mm", false}, low, high});
  data.nodes.assign(1, std::vector<std::int32_t>(25'000, 0));
  const auto event = [](EventKind kind, double t_s) {
    EventRecord e;
    e.kind = kind;
    e.tick = Ticks{static_cast<std::int64_t>(t_s * 1e7)};
    return e;
  };
  data.events = {event(EventKind::feed_override, 20), event(EventKind::alarm, 70),
                 event(EventKind::hold, 70.3)};
  const auto starts = [&](std::int64_t most) {
    std::vector<std::int64_t> out;
    for (const Stretch& s : stretches_of_interest(data, most)) {
      out.push_back(s.first);
      out.push_back(s.ticks);
    }
    return out;
  };
  CHECK(starts(500).empty());
  CHECK(starts(1000) == std::vector<std::int64_t>{69'500, 1000});
  CHECK(starts(2000) == std::vector<std::int64_t>{39'502, 1000, 69'500, 1000});
  CHECK(starts(3000) == std::vector<std::int64_t>{19'500, 1000, 39'502, 1000, 69'500, 1000});
  // overlapping intervals are joined: 69.5 to 70.8 s
  CHECK(starts(10'000) == std::vector<std::int64_t>{19'500, 1000, 39'502, 1000, 69'500, 1300});
}
