#include "planner/path/spline_arcs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "machine/base/axes.h"
#include "machine/base/numbers.h"

namespace kadr::planner {
namespace {

constexpr int kMostHalvings = 20;
constexpr int kSamples = 16;
// samples are no proof between them: the bound on them is kept by a fifth
constexpr double kSampleShare = 0.8;
// ends of a pair point along its chord within 60 degrees: then the pair does not wind
constexpr double kLeastForward = 0.5;
// next to a cusp no pair fits: pieces this short are lines
constexpr double kShortest_mm = 1e-6;
// where the velocity vanishes (a control point on the end) the direction is taken this far inside
constexpr double kInside = 1e-6;

struct Vector {
  double x = 0, y = 0;
  friend Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y}; }
  friend Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y}; }
  friend Vector operator*(double k, Vector a) { return {k * a.x, k * a.y}; }
};
double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y; }
double cross(Vector a, Vector b) { return a.x * b.y - a.y * b.x; }
double norm(Vector a) { return std::sqrt(dot(a, a)); }

/// A point on the curve with its direction.
struct Station {
  double u = 0;
  Vector point, tangent;
};

/// One arc or line from a point along a direction.
CurvePiece piece_from(Vector point, Vector tangent, Vector to) {
  const Vector w = to - point;
  CurvePiece piece;
  piece.end_first_mm = to.x;
  piece.end_second_mm = to.y;
  piece.length_mm = norm(w);
  const double aside = cross(tangent, w);
  // an arc whose end is on its first tangent is a line
  if (std::fabs(aside) < kSamePoint_u) return piece;
  piece.arc = true;
  const double radius = dot(w, w) / (2 * aside);  // signed: > 0 turns counter-clockwise
  piece.center_first_mm = point.x - radius * tangent.y;
  piece.center_second_mm = point.y + radius * tangent.x;
  piece.sweep_rad = 2 * exact_atan2(aside, dot(tangent, w));
  piece.length_mm = std::fabs(radius * piece.sweep_rad);
  return piece;
}

/// Distance of a point from a piece, if its foot lies within the piece.
double distance(const CurvePiece& piece, Vector begin, Vector at) {
  if (!piece.arc) {
    const Vector along = Vector{piece.end_first_mm, piece.end_second_mm} - begin;
    return std::fabs(cross(along, at - begin)) / norm(along);
  }
  const Vector center{piece.center_first_mm, piece.center_second_mm};
  return std::fabs(norm(at - center) - norm(begin - center));
}

class Follower {
 public:
  Follower(const PlaneSpline& spline, double deviation_mm) : spline_(spline), allowed_mm_(deviation_mm) {}

  std::vector<CurvePiece> run() {
    for (span_ = 0; span_ < spline_.spans(); ++span_) follow(station(0), station(1), kMostHalvings);
    return std::move(pieces_);
  }

 private:
  Station station(double u) const {
    const SplineValue at = spline_.eval(span_, u);
    const double inside = std::clamp(u, kInside, 1 - kInside);
    const SplineValue near = spline_.eval(span_, inside);
    Vector velocity{at.first_d1, at.second_d1};
    const Vector near_velocity{near.first_d1, near.second_d1};
    if (norm(velocity) < 1e-3 * norm(near_velocity)) velocity = near_velocity;
    const double speed = norm(velocity);
    return {u, {at.first, at.second}, speed > 0 ? 1 / speed * velocity : Vector{}};
  }

  void follow(const Station& a, const Station& b, int halvings) {
    const Vector chord = b.point - a.point;
    const double length = norm(chord);
    std::array<CurvePiece, 2> pair;
    const bool forward =
        dot(a.tangent, chord) > kLeastForward * length && dot(b.tangent, chord) > kLeastForward * length;
    if (forward) {
      pair = biarc(a, b);
      if (fits(pair, a, b)) {
        for (const CurvePiece& piece : pair) keep(piece);
        return;
      }
    }
    if (halvings == 0 || spline_.length(span_, a.u, b.u) < kShortest_mm)
      return keep(line_to(b.point, length));
    const Station middle = station(0.5 * (a.u + b.u));
    follow(a, middle, halvings - 1);
    follow(middle, b, halvings - 1);
  }

  static CurvePiece line_to(Vector to, double length) {
    CurvePiece piece;
    piece.end_first_mm = to.x;
    piece.end_second_mm = to.y;
    piece.length_mm = length;
    return piece;
  }

  static std::array<CurvePiece, 2> biarc(const Station& a, const Station& b) {
    const Vector v = b.point - a.point;
    const double forward = dot(v, a.tangent + b.tangent);  // > 0
    const Vector turn = a.tangent - b.tangent;
    // 2 (1 - T0 . T1) = |T0 - T1|^2; the root without cancellation
    const double root = std::sqrt(forward * forward + dot(turn, turn) * dot(v, v));
    const double d = dot(v, v) / (forward + root);
    const Vector joint = 0.5 * (a.point + b.point + d * turn);
    // the second arc backwards from its end, so that its direction there is the curve's
    CurvePiece second = piece_from(b.point, -1.0 * b.tangent, joint);
    second.sweep_rad = -second.sweep_rad;
    second.end_first_mm = b.point.x;
    second.end_second_mm = b.point.y;
    return {piece_from(a.point, a.tangent, joint), second};
  }

  bool fits(const std::array<CurvePiece, 2>& pair, const Station& a, const Station& b) const {
    const Vector joint{pair[0].end_first_mm, pair[0].end_second_mm};
    const Vector across = b.point - a.point;
    for (int i = 1; i < kSamples; ++i) {
      const double u = a.u + (b.u - a.u) * i / kSamples;
      const SplineValue value = spline_.eval(span_, u);
      const Vector at{value.first, value.second};
      const bool behind = dot(at - joint, across) > 0;
      const double off = behind ? distance(pair[1], joint, at) : distance(pair[0], a.point, at);
      if (!(off <= kSampleShare * allowed_mm_)) return false;
      if (!(dot({value.first_d1, value.second_d1}, across) > 0)) return false;
    }
    return true;
  }

  void keep(const CurvePiece& piece) {
    if (piece.length_mm > 0) pieces_.push_back(piece);
  }

  const PlaneSpline& spline_;
  double allowed_mm_;
  std::size_t span_ = 0;
  std::vector<CurvePiece> pieces_;
};

}  // namespace

std::vector<CurvePiece> arcs_along(const PlaneSpline& spline, double deviation_mm) {
  return Follower(spline, deviation_mm).run();
}

}  // namespace kadr::planner
