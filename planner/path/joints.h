#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "machine/base/axes.h"

namespace kadr::machine {
struct MachineModel;
}

/// The door between geometry and limits: how every joint moves along a path. A joint is what a motor moves and
/// what AxisModel limits: joint j has the limits of machine axis j. Planner, verifier and interpolator ask
/// Joints, never a shape of the path, for what they compare with a limit of an axis. (A joint of a path, where
/// two of its segments meet, is another thing.)
namespace kadr::planner {

class Path;

/// Where the values at one place of a path go, by joint; an empty span is not computed.
struct JointValues {
  std::span<double> position_u{};  ///< [joints] x, mm or deg
  std::span<double> d1{};          ///< [joints] dx/ds
  std::span<double> d2_per_u{};    ///< [joints] d2x/ds2
  std::span<double> d3_per_u2{};   ///< [joints] d3x/ds3
};

/// How a joint's derivatives lie to each other on a segment: see JointBounds.
enum class JointCourse : std::uint8_t {
  straight,  ///< x' is constant
  circle,    ///< x''' runs against x', and x'' across both
  curve,     ///< x'' runs across x'; x''' has any direction
};

/// Upper bounds of one joint's derivatives over a whole segment: |x'| <= slope, and for all a, b, c
///   circle:  |a x' + b x'' + c x'''| <= skew sqrt((|a| tangent + |c| third)^2 + (b curvature)^2)
///   curve:   |a x' + b x'' + c x'''| <= skew sqrt((a tangent)^2 + (b curvature)^2) + |c| third
/// so that turning (b, c) and accelerating along the path (a) share a limit.
struct JointBounds {
  JointCourse course = JointCourse::straight;
  double slope = 0;
  // without meaning on a straight course
  double tangent = 0;
  double curvature_per_u = 0;
  double third_per_u2 = 0;
  double skew = 1;
};

struct SegmentBounds {
  bool straight = true;        ///< the course of every joint is
  double curvature_per_u = 0;  ///< of the path itself, for its centripetal limit; 0 on a line
  std::array<JointBounds, kProgramAxes> joint{};
};

/// The motion of every joint along a path. s_u is local, from 0 to the segment's length.
class Joints {
 public:
  virtual ~Joints() = default;

  const Path& path() const { return path_; }
  std::size_t size() const { return size_; }  ///< number of joints, at most kProgramAxes
  /// The axes of the path as joints, by which limits of the path count. Of a direct machine: itself.
  virtual const Joints& axes() const = 0;

  /// Exact to rounding; at both ends the derivatives of this segment, not of its neighbour.
  virtual void at(std::size_t segment, double s_u, const JointValues& out) const = 0;
  /// Sets the first size() joints of `out`.
  virtual void bound(std::size_t segment, SegmentBounds& out) const = 0;
  /// Smallest and largest position on a segment.
  virtual std::pair<double, double> extent_u(std::size_t segment, std::size_t joint) const = 0;
  virtual bool moves(std::size_t segment, std::size_t joint) const = 0;
  /// Angle of the circle that joints run on, 0 where there is none.
  virtual double turn_rad(std::size_t segment) const = 0;

 protected:
  /// @param path  outlives this
  Joints(const Path& path, std::size_t joints) : path_(path), size_(joints) {}
  Joints(const Joints&) = default;
  Joints& operator=(const Joints&) = delete;

 private:
  const Path& path_;
  std::size_t size_;
};

/// Joints of a direct machine: the axes of the path themselves.
class DirectJoints final : public Joints {
 public:
  explicit DirectJoints(const Path& path);
  const Joints& axes() const override { return *this; }
  void at(std::size_t segment, double s_u, const JointValues& out) const override;
  void bound(std::size_t segment, SegmentBounds& out) const override;
  std::pair<double, double> extent_u(std::size_t segment, std::size_t joint) const override;
  bool moves(std::size_t segment, std::size_t joint) const override;
  double turn_rad(std::size_t segment) const override;
};

/// The joints of a machine on a path, which outlives them: of every machine the axes.
std::unique_ptr<const Joints> machine_joints(const Path& path, const machine::MachineModel& machine);

}  // namespace kadr::planner
