#include "planner/time_law/spline_fit.h"

#include <algorithm>
#include <cmath>

#include "machine/base/require.h"
#include "machine/machine.h"
#include "planner/path/path.h"

namespace kadr::planner {
namespace {

using machine::kInfinity;

constexpr int kPlaces = 16;    ///< of a piece, at which it is looked at
constexpr double kNear = 0.9;  ///< of the largest distance found so far: worth a closer look
constexpr int kSections = 50;  ///< of a bracket, each to 0.618 of the last
constexpr double kGolden = 0.6180339887498949;

TablePath joints(const Path& path, const Run& run, SplineEnds ends) {
  const auto axes = static_cast<std::size_t>(path.axes());
  std::vector<double> s, values;
  for (std::size_t i = run.first; i <= run.last + 1; ++i) {
    s.push_back(path.start_s_u[i] - path.start_s_u[run.first]);
    const auto node = path.node(i);
    values.insert(values.end(), node.begin(), node.end());
  }
  return {std::move(s), std::move(values), axes, ends};
}

class Measure {
 public:
  Measure(const TablePath& curve, const Path& path, const Run& run)
      : curve_(curve), path_(path), run_(run), axes_(static_cast<std::size_t>(path.axes())) {}

  void into(SplineFit& fit) const {
    fit.least_slope = kInfinity;
    fit.most_slope = 0.0;
    for (std::size_t row = 1; row < curve_.rows(); ++row) {
      double best = -1.0, at = 0.0;
      for (int k = 0; k <= kPlaces; ++k) {
        const double part = static_cast<double>(k) / kPlaces;
        const double slope = slope_at(place(row, part));
        fit.least_slope = std::min(fit.least_slope, slope);
        fit.most_slope = std::max(fit.most_slope, slope);
        const double d = distance_u(row, part);
        if (d > best) best = d, at = part;
      }
      if (best >= kNear * fit.deviation_u) best = highest(row, at);
      if (best <= fit.deviation_u) continue;
      fit.deviation_u = best;
      fit.deviation_s_u = place(row, at);
      fit.segment = run_.first + row - 1;
    }
  }

 private:
  double place(std::size_t row, double part) const {
    return curve_.row_u(row - 1) + part * (curve_.row_u(row) - curve_.row_u(row - 1));
  }

  double slope_at(double s) const {
    double sum = 0.0;
    for (std::size_t c = 0; c < axes_; ++c) {
      const double slope = curve_.eval(c, s).slope;
      sum += slope * slope;
    }
    return std::sqrt(sum);
  }

  /// Distance of a point of the curve from its chord.
  double distance_u(std::size_t row, double part) const {
    const auto from = path_.node(run_.first + row - 1), to = path_.node(run_.first + row);
    const double s = place(row, part);
    double along = 0.0, length2 = 0.0;
    for (std::size_t c = 0; c < axes_; ++c) {
      const double chord = to[c] - from[c];
      along += (curve_.eval(c, s).value - from[c]) * chord;
      length2 += chord * chord;
    }
    const double foot = std::clamp(along / length2, 0.0, 1.0);
    double sum = 0.0;
    for (std::size_t c = 0; c < axes_; ++c) {
      const double d = curve_.eval(c, s).value - (from[c] + foot * (to[c] - from[c]));
      sum += d * d;
    }
    return std::sqrt(sum);
  }

  /// The largest distance beside a place by golden sections; `at` is moved there.
  double highest(std::size_t row, double& at) const {
    double low = std::max(at - 1.0 / kPlaces, 0.0), high = std::min(at + 1.0 / kPlaces, 1.0);
    for (int i = 0; i < kSections; ++i) {
      const double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
      if (distance_u(row, left) < distance_u(row, right))
        low = left;
      else
        high = right;
    }
    const double best = distance_u(row, 0.5 * (low + high)), before = distance_u(row, at);
    if (best < before) return before;
    at = 0.5 * (low + high);
    return best;
  }

  const TablePath& curve_;
  const Path& path_;
  const Run& run_;
  std::size_t axes_;
};

/// Acceleration along the path that the machine allows on a line, in units of s.
double accel_u_s2(const PathSegment& line, const machine::MachineModel& machine) {
  return line.path_limits ? machine.path.max_accel_mm_s2 * (line.length_u / line.feed_length_u) : kInfinity;
}

/// Feed of a line in units of s, and what gives it.
double feed_u_s(const PathSegment& line, const machine::MachineModel& machine, Signature& why) {
  why = {line.rapid ? LimitedBy::rapid : LimitedBy::program, -1};
  if (!line.path_limits || line.rapid) return line.feed_u_s;
  const double most = machine.path.max_feed_mm_s * (line.length_u / line.feed_length_u);
  if (most >= line.feed_u_s) return line.feed_u_s;
  why = {LimitedBy::path_feed, -1};
  return most;
}

double norm(const double* v, std::size_t axes) {
  double sum = 0.0;
  for (std::size_t c = 0; c < axes; ++c) sum += v[c] * v[c];
  return std::sqrt(sum);
}

}  // namespace

SplineFit fit_spline(const Path& path, const Run& run, SplineEnds ends) {
  require(run.last - run.first >= 2, "a spline goes through at least 4 points");
  SplineFit fit{joints(path, run, ends)};
  Measure(fit.path, path, run).into(fit);
  return fit;
}

void state_fit(const SplineFit& fit, const Path& path, const Run& run, const machine::MachineModel& machine,
               std::optional<std::size_t> nodes, LawProblem& out, std::vector<Signature>& held_by) {
  if (nodes)
    fit.path.sample(*nodes, out);
  else
    fit.path.place_rows(out);
  out.max_feed_u_s.clear();
  out.max_accel_u_s2.clear();
  for (const machine::AxisModel& axis : machine.axis) {
    out.max_feed_u_s.push_back(axis.max_feed_u_s);
    out.max_accel_u_s2.push_back(axis.max_accel_u_s2);
  }
  const double origin = path.start_s_u[run.first];
  const auto s_of = [&](std::size_t joint) { return path.start_s_u[joint] - origin; };
  out.cap_u_s.clear();
  out.interval_accel_u_s2.clear();
  held_by.clear();
  std::size_t line = run.first;
  for (std::size_t i = 0; i < out.nodes(); ++i) {
    double accel = accel_u_s2(path.segments[line], machine);
    for (; line < run.last && s_of(line + 1) < out.s_u[i]; ++line)
      accel = std::min(accel, accel_u_s2(path.segments[line + 1], machine));
    out.interval_accel_u_s2.push_back(accel);
    Signature why;
    double feed = feed_u_s(path.segments[line], machine, why);
    if (line < run.last && s_of(line + 1) == out.s_u[i]) {
      Signature behind;
      const double next = feed_u_s(path.segments[line + 1], machine, behind);
      if (next < feed) feed = next, why = behind;
    }
    double cap = feed / norm(out.slopes(i), out.axes);
    const double bend = norm(out.curvatures(i), out.axes);
    if (path.segments[line].path_limits && cap * cap * bend > machine.path.centripetal_accel_mm_s2) {
      cap = std::sqrt(machine.path.centripetal_accel_mm_s2 / bend);
      why = {LimitedBy::centripetal, -1};
    }
    out.cap_u_s.push_back(cap);
    held_by.push_back(why);
  }
  for (std::size_t i = run.first; i <= run.last; ++i) {
    const double limit = path.segments[i].begin_limit_u_s;
    if (limit < kInfinity) out.zones.push_back({s_of(i), s_of(i), limit});
  }
}

}  // namespace kadr::planner
