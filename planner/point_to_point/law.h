#pragma once
#include <array>
#include <cstddef>
#include <span>

namespace kadr::planner {

/// Where a law is at a moment.
struct PointState {
  double position_u = 0;
  double speed_u_s = 0;
  double accel_u_s2 = 0;
};

/// A jump of acceleration and of jerk at one moment; the motion between the jumps follows from them.
struct PointEdge {
  double time_s = 0;
  double accel_u_s2 = 0;
  double jerk_u_s3 = 0;
};

/// A stretch of constant jerk; a = accel + jerk t from its beginning.
struct PointPiece {
  double begin_s = 0, duration_s = 0;
  double position_u = 0, speed_u_s = 0, accel_u_s2 = 0;  ///< at its beginning
  double jerk_u_s3 = 0;

  PointState at(double since_begin_s) const;
};

/// A motion of one coordinate from rest to rest, as pieces of constant jerk. Every law of paper 001 and those
/// it is measured against are such: rectangular ones have jerk 0 and accelerations that jump.
/// Units: u is whatever the coordinate is measured in (mm, deg; m where energies shall be joules).
/// A value of some 5 kB that owns no memory; copies are independent.
class PointLaw {
 public:
  /// An S-curve shaped by three impulses for each of two modes, the longest law there is, has 72 edges.
  static constexpr std::size_t kMostEdges = 72;

  PointLaw() = default;  ///< no motion: no pieces, 0 s, 0 u
  /// Integrates twice from rest at 0 s. Edges may come in any order; equal moments are joined.
  /// @param edges       up to kMostEdges, times >= 0, such that the motion ends at rest (a promise, checked)
  /// @param distance_u  where it ends, > 0; agrees with the edges to 1e-9 of itself (a promise, checked)
  static PointLaw from_edges(std::span<const PointEdge> edges, double distance_u);

  std::span<const PointPiece> pieces() const { return {pieces_.data(), count_}; }
  /// Jumps in order of time, the last one at the end; n pieces have n + 1.
  std::span<const PointEdge> edges() const { return {edges_.data(), count_ == 0 ? 0 : count_ + 1}; }
  double duration_s() const { return duration_s_; }
  double distance_u() const { return distance_u_; }
  double peak_speed_u_s() const { return peak_speed_u_s_; }
  double peak_accel_u_s2() const { return peak_accel_u_s2_; }  ///< largest |a|
  double peak_jerk_u_s3() const { return peak_jerk_u_s3_; }    ///< largest |jerk|; infinite if a jumps
  /// At rest at 0 before 0 s and at distance_u from duration_s on.
  PointState at(double time_s) const;

 private:
  void measure();

  std::array<PointPiece, kMostEdges - 1> pieces_{};
  std::array<PointEdge, kMostEdges> edges_{};
  std::size_t count_ = 0;
  double duration_s_ = 0, distance_u_ = 0;
  double peak_speed_u_s_ = 0, peak_accel_u_s2_ = 0, peak_jerk_u_s3_ = 0;
};

}  // namespace kadr::planner
