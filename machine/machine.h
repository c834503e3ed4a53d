#pragma once
#include <optional>
#include <string>
#include <vector>

#include "machine/axis.h"
#include "machine/base/axes.h"
#include "machine/clock.h"
#include "machine/owner_codes.h"
#include "machine/settings.h"
#include "machine/step_method.h"

/// The machine: facts that are true before a program is loaded. Read by all, changed by none. Code that only
/// passes it on declares it (struct MachineModel); machine_file.h reads it from a file. Units: `_u` is the
/// axis's own unit, mm for a linear and degrees for a rotary axis.
namespace kadr::machine {

struct MachineModel {
  std::string name;
  std::optional<StartUnits> units;  ///< none: mm, and a program that does not say its units is warned of
  std::string startup;              ///< G codes in force before a program's first line; may be empty
  ClockModel clock;
  std::vector<AxisModel> axis;  ///< [machine axes], 1..9, in the order of the file
  PathLimits path;
  PlannerSettings planner;
  StepMethod interpolator = StepMethod::crossing;
  OverrideSettings feed_override;
  SpindleReaction spindle;
  PlantSettings plant;
  LogSettings log;
  OnAlarm on_alarm = OnAlarm::report;
  std::optional<StockModel> stock;
  std::vector<TechnologyRule> technology;  ///< [rules], in the order of the file
  OwnerCodes codes;                        ///< G and M codes of the owner
  AxisValues home2{};                      ///< G30 position, machine coordinates
  /// Axes that move together where a program is entered, one group after the other: {"XY", "Z"}; each axis once. Empty:
  /// all but Z together, and Z last where it goes down, first where it goes up.
  std::vector<std::string> approach;

  /// Index in `axis` by letter, -1 if the machine has no such axis.
  int find_axis(char letter) const;
  bool operator==(const MachineModel&) const = default;
};

}  // namespace kadr::machine
