#include "planner/path/path_cut.h"

#include <algorithm>
#include <utility>

#include "machine/base/require.h"

namespace kadr::planner {
namespace {

constexpr double kNear = 1e-9;  ///< of s: a joint is there already

}  // namespace

std::size_t cut_path(Path& path, double s) {
  require(path.size() > 0 && s >= 0.0 && s <= path.length_u(), "a path is cut within its length");
  const auto behind = std::upper_bound(path.start_s_u.begin(), path.start_s_u.end(), s);
  const auto at = std::min(static_cast<std::size_t>(behind - path.start_s_u.begin()) - 1, path.size() - 1);
  const double slack = kNear * std::max(s, 1.0), local = s - path.start_s_u[at];
  if (local <= slack) return at;
  if (path.start_s_u[at + 1] - s <= slack) return at + 1;

  const auto axes = static_cast<std::size_t>(path.axes());
  std::array<double, kProgramAxes> place{};
  eval_position(path, at, local, {place.data(), axes});
  PathSegment& first = path.segments[at];
  PathSegment second = first;
  const double part = local / first.length_u;
  second.length_u = first.length_u - local;
  second.feed_length_u = first.feed_length_u * (1.0 - part);
  second.begin_limit_u_s = machine::kInfinity;
  first.length_u = local;
  first.feed_length_u *= part;
  first.stop_at_end = false;
  if (first.kind == SegmentKind::arc) {
    ArcShape& arc = path.arcs[static_cast<std::size_t>(first.shape)];
    ArcShape rest = arc;
    arc.sweep_rad *= part;
    arc.radius_end_u = arc.radius_begin_u + (rest.radius_end_u - rest.radius_begin_u) * part;
    rest.angle_begin_rad += arc.sweep_rad;
    rest.sweep_rad -= arc.sweep_rad;
    rest.radius_begin_u = arc.radius_end_u;
    second.shape = static_cast<std::int32_t>(path.arcs.size());
    path.arcs.push_back(rest);
  } else if (first.kind == SegmentKind::curve) {
    PathCurve& curve = path.curves[static_cast<std::size_t>(first.shape)];
    const double t = curve.t(local);
    PathCurve rest = curve.part(t, 1.0);
    curve = curve.part(0.0, t);
    first.length_u = curve.length_u();
    second.length_u = rest.length_u();
    second.shape = static_cast<std::int32_t>(path.curves.size());
    path.curves.push_back(std::move(rest));
  }
  const auto offset = static_cast<std::ptrdiff_t>(at + 1);
  path.segments.insert(path.segments.begin() + offset, second);
  path.start_s_u.insert(path.start_s_u.begin() + offset, s);
  path.nodes_u.insert(path.nodes_u.begin() + offset * path.axes(), place.begin(),
                      place.begin() + path.axes());
  return at + 1;
}

}  // namespace kadr::planner
