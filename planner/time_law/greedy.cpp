#include "planner/time_law/greedy.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace kadr::planner {
namespace {

using machine::kInfinity;

constexpr double kParallel = 1e-14;  ///< coefficients, of a row scaled to 1, that count as 0
constexpr double kInside = 1e-12;    ///< rounding of a row
constexpr double kMeets = 1e-9;      ///< by which two ends may miss each other

struct Range {
  double low, high;
};

/// The strips |a x + b y| <= 1 of one interval, x before and y after it, in units of the highest squared speed.
struct Strips {
  std::vector<double> a, b;
};

/// Greatest or least x of the strips within x in [0, most_x], y in y_range: Seidel's incremental method in
/// fixed order. Half planes come in pairs, so row r is |a x + b y| <= 1 seen from either side.
class Projection {
 public:
  Projection(const Strips& strips, double most_x, Range y) : strips_(strips), most_x_(most_x), y_(y) {}

  /// @return whether there is a point; x of it
  bool extreme(bool greatest, double& x) const {
    double px = greatest ? most_x_ : 0.0, py = y_.high;
    for (std::size_t i = 0; i < 2 * strips_.a.size(); ++i) {
      const double a = side(i) * strips_.a[i / 2], b = side(i) * strips_.b[i / 2];
      if (a * px + b * py <= 1.0 + kInside) continue;
      if (!on_line(i, a, b, greatest, px, py)) return false;
    }
    x = px;
    return true;
  }

 private:
  static double side(std::size_t i) { return i % 2 == 0 ? 1.0 : -1.0; }

  /// Best point of the line a x + b y = 1 within the box and the half planes before i.
  bool on_line(std::size_t i, double a, double b, bool greatest, double& px, double& py) const {
    const double norm = a * a + b * b;
    if (norm < kParallel * kParallel) return false;
    const double x0 = a / norm, y0 = b / norm, dx = -b,
                 dy = a;  // point of the line nearest to 0, and its direction
    double low = -1e30, high = 1e30;
    const auto clip = [&](double k, double r) {  // k t <= r
      if (std::fabs(k) < kParallel) return r >= -kMeets;
      if (k > 0.0)
        high = std::min(high, r / k);
      else
        low = std::max(low, r / k);
      return true;
    };
    bool is = clip(dx, most_x_ - x0) && clip(-dx, x0) && clip(dy, y_.high - y0) && clip(-dy, y0 - y_.low);
    for (std::size_t j = 0; j < i && is; ++j) {
      const double aj = side(j) * strips_.a[j / 2], bj = side(j) * strips_.b[j / 2];
      is = clip(aj * dx + bj * dy, 1.0 - aj * x0 - bj * y0);
    }
    if (!is || low > high + kMeets * (1.0 + std::fabs(low))) return false;
    const double t = (dx >= 0.0) == greatest ? high : low;
    px = x0 + t * dx;
    py = y0 + t * dy;
    return true;
  }

  const Strips& strips_;
  double most_x_;
  Range y_;
};

/// One pass backward, one pass forward over squared speeds, in units of the highest.
class Reachability {
 public:
  explicit Reachability(const LawProblem& p)
      : p_(p),
        caps_(node_caps(p)),
        rows_(accel_rows(p)),
        strips_{std::vector<double>(rows_.per_interval), std::vector<double>(rows_.per_interval)} {
    double fastest = 0;
    for (const NodeCap& c : caps_) fastest = std::max(fastest, c.speed_u_s);
    unit_ = fastest * fastest;
  }

  /// @return [nodes] the squared speeds from which the end can be reached
  tl::expected<std::vector<Range>, LawFailure> backward() {
    const std::size_t n = p_.nodes();
    std::vector<Range> reach(n);
    reach[n - 1] = {squared(p_.end_u_s), squared(p_.end_u_s)};
    for (std::size_t i = n - 1; i > 0; --i) {
      fill(i);
      const Projection projection(strips_, squared(caps_[i - 1].speed_u_s), reach[i]);
      double low, high;
      if (!projection.extreme(true, high) || !projection.extreme(false, low))
        return tl::unexpected(
            LawFailure{i - 1, p_.s_u[i - 1],
                       fmt::format("at no speed up to {:.6g} mm/s can the path after it be followed",
                                   caps_[i - 1].speed_u_s)});
      reach[i - 1] = {std::max(low, 0.0), std::min(high, squared(caps_[i - 1].speed_u_s))};
    }
    return reach;
  }

  /// @return [nodes] the highest speeds within reach
  tl::expected<std::vector<double>, LawFailure> forward(const std::vector<Range>& reach) {
    double x = squared(p_.begin_u_s);
    if (x < reach[0].low - kInside || x > reach[0].high + kInside)
      return tl::unexpected(LawFailure{
          0, p_.s_u[0],
          fmt::format(
              "the speed must be {:.6g} mm/s, but the path can only be followed at {:.6g} to {:.6g} mm/s",
              p_.begin_u_s, std::sqrt(reach[0].low * unit_), std::sqrt(reach[0].high * unit_))});
    std::vector<double> speed(reach.size());
    speed.front() = p_.begin_u_s;
    for (std::size_t i = 1; i < speed.size(); ++i) {
      fill(i);
      const Range next = within(x, reach[i]);
      if (next.high < next.low - kMeets * (1.0 + next.low))
        return tl::unexpected(LawFailure{
            i, p_.s_u[i],
            fmt::format("at least {:.6g} mm/s is needed, but only {:.6g} mm/s can be reached",
                        std::sqrt(next.low * unit_), std::sqrt(std::max(next.high, 0.0) * unit_))});
      x = std::max(next.high, 0.0);
      speed[i] = std::sqrt(x * unit_);
    }
    speed.back() = p_.end_u_s;
    return speed;
  }

 private:
  double squared(double v) const { return v * v / unit_; }

  /// The strips of the interval that ends at a node.
  void fill(std::size_t i) {
    for (std::size_t r = 0; r < rows_.per_interval; ++r) {
      strips_.a[r] = rows_.before[i * rows_.per_interval + r] * unit_;
      strips_.b[r] = rows_.after[i * rows_.per_interval + r] * unit_;
    }
  }

  /// The part of a range that the strips allow after x.
  Range within(double x, Range range) const {
    for (std::size_t r = 0; r < rows_.per_interval; ++r) {
      const double b = strips_.b[r];
      if (std::fabs(b) < kParallel) continue;
      const double one = (1.0 - strips_.a[r] * x) / b, other = (-1.0 - strips_.a[r] * x) / b;
      range.high = std::min(range.high, std::max(one, other));
      range.low = std::max(range.low, std::min(one, other));
    }
    return range;
  }

  const LawProblem& p_;
  std::vector<NodeCap> caps_;
  AccelRows rows_;
  Strips strips_;
  double unit_ = 0;  // highest squared speed
};

}  // namespace

LawResult GreedyOptimum::solve(const LawProblem& p) {
  Reachability reachability(p);
  const auto reach = reachability.backward();
  if (!reach) return tl::unexpected(reach.error());
  auto speed = reachability.forward(*reach);
  if (!speed) return tl::unexpected(std::move(speed.error()));
  LawSolution out = summed(p, std::move(*speed));
  out.iterations = 1;
  return out;
}

}  // namespace kadr::planner
