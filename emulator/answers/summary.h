#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "emulator/answers/approach.h"
#include "emulator/log/records.h"

namespace kadr::answers {

/// Context of a run for its summary.
struct SummaryContext {
  std::string program;   ///< as the user gave it
  std::string machine;   ///< name and where it comes from
  std::string scenario;  ///< empty: none
  const machine::MachineModel* model = nullptr;
  std::string path_unit = "mm";          ///< unit of path length
  std::optional<ApproachRow> approach;   ///< as planned; what the summary says of path and feed is without it
  bool plant = true;                     ///< false: run with --no-plant
  std::size_t program_warnings = 0;      ///< reported before the run
  std::vector<log::EventRecord> alarms;  ///< in time order, perhaps only the first
  std::map<Code, std::size_t> alarm_counts;
  std::string log_path;                   ///< empty: no log
  std::optional<std::int64_t> log_bytes;  ///< of a log in a file; a pipe or device has no size
  double wall_s = -1;                     ///< < 0: leave the last line out
};

/// The table after a run, for people. The wall-clock line is the last one; all others depend only on the inputs.
std::string render_summary(const log::RunSummary& summary, const SummaryContext& context);
/// "limited by     program 61 %  junction 19 %"; empty if there is no time to share.
std::string render_limits(const std::vector<log::LimitShare>& shares);

}  // namespace kadr::answers
