#include "planner/bezier/arc_length.h"

#include <algorithm>
#include <cmath>

#include "machine/base/require.h"

namespace kadr::planner {
namespace {

// Gauss-Legendre, eight points on [-1, 1]: the four on one side
constexpr double kPlace[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
constexpr double kWeight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                               0.1012285362903763};
constexpr int kFewestPanels = 16, kMostPanels = 1 << 14;
constexpr double kSettled = 1e-14;
constexpr int kMostIterations = 100;
constexpr int kFewestParts = 8, kMostParts = 4096;

}  // namespace

ArcLength::ArcLength(const Bezier& curve) : curve_(curve) {
  double before = 0;
  for (int panels = kFewestPanels;; panels *= 2) {
    sums_u_.assign(1, 0.0);
    for (int i = 0; i < panels; ++i)
      sums_u_.push_back(sums_u_.back() + panel_u(static_cast<double>(i) / panels, (i + 1.0) / panels));
    const bool settled = std::fabs(sums_u_.back() - before) <= kSettled * sums_u_.back();
    if (settled || panels == kMostPanels) return;
    before = sums_u_.back();
  }
}

double ArcLength::panel_u(double from, double to) const {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    sum += kWeight[i] * (curve_.speed(middle - half * kPlace[i]) + curve_.speed(middle + half * kPlace[i]));
  return sum * half;
}

double ArcLength::s_u(double t) const {
  const auto panels = static_cast<double>(sums_u_.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(t * panels), sums_u_.size() - 2);
  return sums_u_[i] + panel_u(static_cast<double>(i) / panels, t);
}

double ArcLength::t(double s_u) const {
  if (!(s_u > 0)) return 0;
  if (s_u >= length_u()) return 1;
  const auto above = std::upper_bound(sums_u_.begin(), sums_u_.end(), s_u);
  const auto i = static_cast<std::size_t>(above - sums_u_.begin()) - 1;
  const auto panels = static_cast<double>(sums_u_.size() - 1);
  const double begin = static_cast<double>(i) / panels;
  double low = begin, high = static_cast<double>(i + 1) / panels;
  double at = low + (high - low) * (s_u - sums_u_[i]) / (sums_u_[i + 1] - sums_u_[i]);
  for (int n = 0; n < kMostIterations; ++n) {
    const double ahead = sums_u_[i] + panel_u(begin, at) - s_u;
    (ahead > 0 ? high : low) = at;
    double next = at - ahead / curve_.speed(at);
    if (std::fabs(next - at) <= 1e-16) return next;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == at) return at;
    at = next;
  }
  return at;
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
    // between its nodes a quintic piece is worst near the quarters (feed) and the middle (place)
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
