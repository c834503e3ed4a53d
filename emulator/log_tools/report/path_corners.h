#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

/// The commanded path as few straight lines, for a picture of it: lattice nodes after chosen control ticks.
namespace kadr::log_tools {

struct PathCorners {
  std::vector<std::int32_t> ticks;               ///< [corners] control ticks since the first, ascending
  std::vector<std::vector<std::int32_t>> nodes;  ///< [axes][corners] exact nodes after these control ticks
  std::size_t size() const { return ticks.size(); }
};

/// Takes a path control tick by control tick and keeps the corners: every node lies within the tolerance of
/// the line between its neighbouring corners.
///
/// From the last corner on the line is extended as long as no node along it is farther off, and no longer
/// than kLongest nodes, so that a corner also shows what happened before it. Too many corners double the
/// tolerance; what is kept is then thinned in the same way, within twice the tolerance in the end.
class CornerFinder {
 public:
  static constexpr std::size_t kLongest = 64;
  /// @param step_mm  [axes] mm a lattice step; 0: the axis is not part of the picture
  /// @param most     corners kept, > 1
  CornerFinder(std::vector<double> step_mm, double tolerance_mm, std::size_t most);
  /// @param nodes  [axes]
  void add(std::int32_t tick, const std::vector<std::int32_t>& nodes);
  /// Corners so far; the node taken last is one.
  PathCorners corners() const;
  double tolerance_mm() const { return tolerance_mm_; }

 private:
  struct Sample {
    std::int32_t tick = 0;
    std::vector<std::int32_t> at;
  };
  double off_mm2(const Sample& from, const Sample& to, const Sample& node) const;
  void keep(const Sample& node);

  std::vector<double> step_mm_;
  double tolerance_mm_;
  std::size_t most_;
  PathCorners kept_;
  Sample last_;                  // the corner kept last
  std::vector<Sample> waiting_;  // behind it
};

/// At most `most` corners of a path.
/// @param tolerance_mm  to begin with; doubled until they are few enough
PathCorners thinned(PathCorners corners, const std::vector<double>& step_mm, double& tolerance_mm,
                    std::size_t most);

}  // namespace kadr::log_tools
