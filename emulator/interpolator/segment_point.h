#pragma once
#include <cstddef>
#include <span>

#include "planner/path.h"

namespace kadr::emulator {

/// Position [axis units] and tangent dx/ds of every axis on a segment at s_u in [0, length] from its
/// beginning, straight from the definitions in planner/path.h; the position at both ends is the node itself,
/// bit for bit. Whole turns are taken off before sine and cosine, so that a thousand turns cost no digits but
/// those of s.
void eval_segment(const planner::Path& path, std::size_t segment, double s_u, std::span<double> position_u,
                  std::span<double> tangent);

}  // namespace kadr::emulator
