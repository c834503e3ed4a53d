#pragma once
#include <string>

#include "emulator/studies/teach/bezier_study.h"
#include "emulator/text/json.h"

namespace kadr::studies {

/// Checks of a chain of Beziers; 0: none.
struct BezierDemand {
  double feed_mm_s = 0;
  double acceleration_mm_s2 = 0;
};

/// Whether the curves meet, and the feed is allowed on every curve and joint.
bool allowed(const BezierStudy& study, const BezierDemand& demand);
/// One paragraph per curve and joint: polynomials, length, radius, allowed feed, jumps, repairs, errors of t(S).
std::string render_beziers(const BezierStudy& study, const BezierDemand& demand);
text::Json json_of(const BezierStudy& study, const BezierDemand& demand);

}  // namespace kadr::studies
