#pragma once
#include <string>
#include <vector>

#include "emulator/answers/approach.h"
#include "emulator/answers/travel.h"
#include "emulator/emulator.h"

namespace kadr::answers {

/// The result of `kadr check` for a program that could be planned.
struct CheckResult {
  double time_s = 0;  ///< with acceleration, dwells included
  double motion_s = 0;
  double dwell_s = 0;
  double rapid_s = 0;  ///< part of motion_s spent in rapids
  /// its time is part of motion_s, and of nothing else here but the axes' travel and the shares of time
  std::optional<ApproachRow> approach;
  double path_u = 0;
  double rapid_path_u = 0;  ///< part of path_u that is rapid
  std::string path_unit;
  std::uint32_t blocks = 0;
  double peak_u_s = 0;  ///< highest planned feed
  std::uint32_t peak_line = 0;
  std::vector<AxisTravel> travel;  ///< [axes]
  std::vector<log::LimitShare> limited_by;
};

CheckResult check_result(const cycle::Job& job);
/// The table for people.
std::string render_check(const CheckResult& result, const std::string& program,
                         const std::string& machine_text, const machine::MachineModel& model);

}  // namespace kadr::answers
