#pragma once
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <vector>

#include "emulator/interpolator/lattice/lattice.h"

/// What the tests of the lattice methods share: runs as nodes and as letters, and measures of their own.
namespace kadr::test {

namespace lattice = interpolator::lattice;
using lattice::ArcCurve;
using lattice::Curve;
using lattice::LineCurve;
using lattice::Method;
using lattice::PlaneNode;
using lattice::Trace;
using lattice::Turn;

inline Trace trace(const Curve& curve, Method method, const lattice::MethodOptions& options = {},
                   std::int64_t most_slots = 10'000'000) {
  const lattice::Made made = lattice::make_stepper(curve, method, options);
  if (!made.stepper) return {};
  return lattice::run(*made.stepper, curve, most_slots);
}

inline LineCurve line(std::initializer_list<std::int64_t> delta) {
  LineCurve out{static_cast<int>(delta.size()), {}};
  std::size_t k = 0;
  for (const std::int64_t d : delta) out.delta[k++] = d;
  return out;
}

/// Nodes of a plane run, the beginning among them.
inline std::vector<PlaneNode> nodes(const Trace& t) {
  std::vector<PlaneNode> out = {{t.begin[0], t.begin[1]}};
  for (const lattice::Slot& s : t.slots) out.push_back({out.back().x + s.step[0], out.back().y + s.step[1]});
  return out;
}

/// "XYXX": a letter a step, a blank between slots where one holds two.
inline std::string letters(const Trace& t) {
  std::string out;
  bool wide = false;
  for (const lattice::Slot& s : t.slots) wide = wide || (s.step[0] != 0 && s.step[1] != 0);
  for (const lattice::Slot& s : t.slots) {
    if (wide && !out.empty()) out += ' ';
    if (s.step[0] != 0) out += 'X';
    if (s.step[1] != 0) out += 'Y';
  }
  return out;
}

inline std::vector<std::int64_t> tested(const Trace& t) {
  std::vector<std::int64_t> out;
  for (const lattice::Slot& s : t.slots) out.push_back(s.tested);
  return out;
}

inline double radial(PlaneNode n, double radius) {
  return std::hypot(static_cast<double>(n.x), static_cast<double>(n.y)) - radius;
}

/// Distance in the larger of |dx|, |dy| from a node to the circle of squared radius q, by halving: the square
/// about the node that just touches it.
inline double square_distance(double q, PlaneNode n) {
  const double x = std::fabs(static_cast<double>(n.x)), y = std::fabs(static_cast<double>(n.y));
  double low = 0, high = 2 * std::sqrt(q) + 2;
  for (int i = 0; i < 60; ++i) {
    const double r = (low + high) / 2, u = std::fmax(x - r, 0.0), v = std::fmax(y - r, 0.0);
    const bool touches = x * x + y * y >= q ? u * u + v * v <= q : (x + r) * (x + r) + (y + r) * (y + r) >= q;
    (touches ? high : low) = r;
  }
  return high;
}

inline bool full_sweep() { return std::getenv("KADR_COUNT") != nullptr; }

}  // namespace kadr::test
