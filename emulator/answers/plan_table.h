#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulator/emulator.h"

namespace kadr::answers {

/// One motion block of a planned program, a pause between motions (dwell, tool change), or the approach before it.
struct PlanRow {
  std::uint32_t line = 0;
  std::string text;     ///< the program line as written
  std::string motion;   ///< "rapid" "line" "arc" "dwell" "tool change"
  std::string unit;     ///< "mm" or "deg": what F measures here; empty for a pause
  double length_u = 0;  ///< in `unit`, as are the speeds
  double begin_s = 0;   ///< since program start
  double time_s = 0;
  double programmed_u_s = 0;  ///< programmed speed along the path; 0 for a rapid or a pause
  double peak_u_s = 0;        ///< highest speed reached
  double end_u_s = 0;         ///< speed at the block's end
  std::string limited_by;     ///< what limited the peak; empty for a pause
  std::string
      stops_for;  ///< the code that makes the motion stop at its end, "spindle clockwise (line 4)"; or empty
  std::vector<std::string> ways;  ///< of the approach (ApproachRow), whose row is one of a pause otherwise
  // of a plan made block by block
  bool blockwise = false;
  std::string rule;         ///< how the block came to whole control ticks: "a" to "d", or ""
  double kl = 1;            ///< lowest factor on its speeds (paper 003, eq. 3)
  double end_jump_u_s = 0;  ///< largest jump of speed at its end, or at an inner joint of a curve
  // of a rapid that planner.rapid_law takes care of
  bool positioned = false;
  std::string rapid_law;     ///< "t-zero" "zv" "zvd", or "scurve" where nothing rings
  std::string rapid_reason;  ///< of an automatic choice, else empty
  double rapid_loss_s = 0;   ///< over the fastest way within the limits
  struct Vibration {
    char axis = 'X';
    double hz = 0, zeta = 0;  ///< of the driven system
  };
  std::vector<Vibration> vibrations;  ///< that it excites, largest first
  /// amplitude of the remaining vibration, of the axes that have a plant
  std::vector<std::pair<char, double>> residual_u;
};

/// Calls `sink` for each row in program order. Nothing is kept, so a program of a million lines costs no memory.
void for_each_plan_row(const cycle::Job& job, const std::function<void(const PlanRow&)>& sink);

/// Column titles and rows of the table for people; widths are fixed by the whole plan, so that rows can be streamed.
class PlanTable {
 public:
  explicit PlanTable(const cycle::Job& job);
  std::string title() const;
  std::string row(const PlanRow& row) const;
  /// "17 rows, 38.412 s: 36.212 s in motion, 2.200 s standing"
  std::string footer(const cycle::Job& job, std::size_t rows) const;

 private:
  bool mixed() const { return unit_ == "mm+deg"; }
  std::string head(std::string_view name, std::string_view per = {}) const;

  bool blockwise_ = false;
  std::string unit_;  ///< of all rows; "mm+deg": rows of both kinds, each with its own unit
  std::size_t line_width_ = 0, length_width_ = 0, time_width_ = 0, speed_width_ = 0;
};

/// "line,motion,unit,length_u,begin_s,..."; `_u` is in the row's own unit. A plan made block by block has
/// rule, kl and jump before the text, one with a planner.rapid_law the rapid's law and loss_s.
std::string plan_csv_title(const machine::MachineModel& machine);
/// Dot, comma, LF; shortest digits that read back to the same number; text in quotes.
std::string plan_csv_row(const PlanRow& row, const machine::MachineModel& machine);

}  // namespace kadr::answers
