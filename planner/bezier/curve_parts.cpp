#include "planner/bezier/curve_parts.h"

#include <algorithm>

#include "planner/bezier/curve_bounds.h"
#include "planner/bezier/path_curve.h"

namespace kadr::planner {
namespace {

constexpr int kMostHalvings = 6;
constexpr double kAlike = 0.7;        // of the largest curvature
constexpr double kSlowest = 1e-3;     // of the largest |B'|: a cusp
constexpr int kSpeedPlaces = 64;      // points where |B'| is sampled
constexpr double kSharpest_u = 1e-3;  // a radius below is a cusp too

struct Cutter {
  std::span<const double> control_u;
  std::size_t axes;
  double harmless_per_u;
  std::vector<std::vector<double>> parts{};

  bool halve(double from, double to, int halvings) {
    std::vector<double> part = part_of_curve(control_u, axes, from, to);
    const CurveBounds bounds = curve_bounds(PathCurve(part, axes));
    const double most = bounds.curvature_per_u;
    // also when it is not a number
    if (halvings == 0 && !(most * kSharpest_u < 1)) return false;
    if (halvings == 0 || bounds.curvature_least_per_u >= kAlike * most || most <= harmless_per_u) {
      parts.push_back(std::move(part));
      return true;
    }
    const double middle = 0.5 * (from + to);
    return halve(from, middle, halvings - 1) && halve(middle, to, halvings - 1);
  }
};

}  // namespace

std::optional<std::vector<std::vector<double>>> parts_of_like_curvature(std::span<const double> control_u,
                                                                        std::size_t axes,
                                                                        double harmless_per_u) {
  const PathCurve whole(control_u, axes);
  double slowest = whole.speed(0), fastest = slowest;
  for (int i = 1; i <= kSpeedPlaces; ++i) {
    const double speed = whole.speed(static_cast<double>(i) / kSpeedPlaces);
    slowest = std::min(slowest, speed);
    fastest = std::max(fastest, speed);
  }
  if (!(slowest > kSlowest * fastest)) return {};
  Cutter cutter{control_u, axes, harmless_per_u};
  if (!cutter.halve(0, 1, kMostHalvings)) return {};
  return std::move(cutter.parts);
}

}  // namespace kadr::planner
