#include "planner/bezier/arc_length.h"

#include <algorithm>
#include <cmath>

#include "machine/base/require.h"

namespace kadr::planner {
namespace {

constexpr int kFewestPanels = 16;
constexpr int kFewestParts = 8, kMostParts = 4096;

}  // namespace

ArcLength::ArcLength(const Bezier& curve) : curve_(curve) {
  panels_.measure([&](double t) { return curve_.speed(t); }, kFewestPanels);
}

double ArcLength::s_u(double t) const {
  return panels_.s_u([&](double at) { return curve_.speed(at); }, t);
}

double ArcLength::t(double s_u) const {
  return panels_.t([&](double at) { return curve_.speed(at); }, s_u);
}

ArcTable::ArcTable(const ArcLength& arc, int parts)
    : parts_(parts),
      last_(static_cast<std::size_t>(parts) - 1),
      length_u_(arc.length_u()),
      parts_per_u_(parts / arc.length_u()) {
  require(parts >= 1, "a table has parts");
  const double h = length_u_ / parts;
  struct End {
    double t, first, second;  // by the share of the part
  };
  const auto end = [&](int i) {
    const double t = i == 0 ? 0 : i == parts ? 1 : arc.t(length_u_ * i / parts);
    const BezierVector d = arc.curve().derivative(t);
    const double speed2 = dot(d, d);
    return End{t, h / std::sqrt(speed2), -dot(d, arc.curve().second(t)) / (speed2 * speed2) * h * h};
  };
  End a = end(0);
  for (int i = 0; i < parts; ++i) {
    const End b = end(i + 1);
    const double d = b.t - a.t;
    pieces_.push_back({a.t, a.first, 0.5 * a.second,
                       10 * d - 6 * a.first - 4 * b.first - 1.5 * a.second + 0.5 * b.second,
                       -15 * d + 8 * a.first + 7 * b.first + 1.5 * a.second - b.second,
                       6 * d - 3 * a.first - 3 * b.first - 0.5 * a.second + 0.5 * b.second});
    a = b;
  }
}

double ArcTable::dt_ds(double s_u) const {
  double x = s_u * parts_per_u_;
  const auto i = std::min(static_cast<std::size_t>(x > 0 ? x : 0), last_);
  x -= static_cast<double>(i);
  const Piece& c = pieces_[i];
  return (c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * 5 * c[5])))) * parts_per_u_;
}

ArcTable ArcTable::fitted(const ArcLength& arc, double feed_error, double place_error) {
  for (int parts = kFewestParts;; parts *= 2) {
    ArcTable table(arc, parts);
    bool good = true;
    // between its nodes a quintic piece is worst near the quarters (feed) and the middle (position)
    for (int i = 0; i < 8 * parts && good; ++i) {
      const double s = arc.length_u() * (i + 0.5) / (8.0 * parts), t = table.t(s);
      good = std::fabs(table.dt_ds(s) * arc.curve().speed(t) - 1) <= feed_error &&
             std::fabs(arc.s_u(t) - s) <= place_error * arc.length_u();
    }
    if (good || parts == kMostParts) return table;
  }
}

double polished(const ArcLength& arc, double t, double s_u) {
  if (t <= 0 || t >= 1) return t;
  return t - (arc.s_u(t) - s_u) / arc.curve().speed(t);
}

double error_place(int i) {
  if (i + 1 == kErrorPlaces) return 1;
  return (1 - std::cos(M_PI * i / (kErrorPlaces - 1))) / 2;
}

}  // namespace kadr::planner
