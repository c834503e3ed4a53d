#pragma once
#include <string>

#include "emulator/studies/point_to_point/point_study.h"

namespace kadr::studies {

/// Laws from rest to rest as one HTML file without script: acceleration, speed, power and the load's vibration
/// over time, a close-up of the residual, and the table. No wall clock, so equal runs give equal bytes.
std::string render_point_page(const PointQuestion& question, const PointStudy& study);

}  // namespace kadr::studies
