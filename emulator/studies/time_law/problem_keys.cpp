#include "emulator/studies/time_law/problem_keys.h"

namespace kadr::studies {

std::string in_unit(std::string_view name, PathUnit unit) {
  constexpr std::string_view kPlaceOfUnit = "{u}";
  std::string text(name);
  if (const auto at = text.find(kPlaceOfUnit); at != std::string::npos)
    text.replace(at, kPlaceOfUnit.size(), kPathUnits.word(unit));
  return text;
}

machine::Reading<double> read_axis_key(machine::TableReader& r, const machine::NumberKey& key, PathUnit unit,
                                       std::optional<double> otherwise) {
  return r.number(in_unit(key.name, unit), key.bounds, otherwise);
}

std::vector<machine::TableDocument> problem_keys() {
  machine::Documents d;
  d.table("", "before all tables").one(kProblemFormat).one(kProblemName);
  d.table("[path]", "a path by table, program or formula, and limits along it")
      .one(kPathTable)
      .one(kPathProgram)
      .one(kPathMachine)
      .one(kPathTools)
      .one(kPathFromLine)
      .one(kPathToLine)
      .one(kPathFit)
      .one(kPathTolerance)
      .one(kPathNodeStep)
      .one(kPathEnds)
      .one(kPathLength)
      .one(kPathNodes)
      .one(kPathSpeed)
      .one(kPathAcceleration)
      .one(kPathBegin)
      .one(kPathEnd)
      .one(kPathAccelTest);
  d.table("[[axis]]", "one for each axis; names of keys end in its unit: mm, deg or rad")
      .one(kPathAxisName)
      .one(kPathAxisUnit)
      .one(kPathAxisSpeed)
      .one(kPathAxisAcceleration)
      .all(kFormulaKeys)
      .one(kAxisWaves)
      .one(kAxisSteps);
  d.table("[[axis.waves]]", "adds amplitude sin(2 pi turns s/length + phase)").all(kWaveKeys);
  d.table("[[axis.steps]]", "adds height tanh((s - at)/width)").all(kStepKeys);
  d.table("[[zone]]", "where the process allows less; optional")
      .one(kZoneAt)
      .one(kZoneFrom)
      .one(kZoneTo)
      .one(kZoneLine)
      .one(kZoneSpeed);
  d.table("[penalty]", "what J counts beside time; optional").one(kPenaltyWeight).one(kPenaltyPerLength);
  d.table("[tube]", "the method tube; optional").one(kTubeGrid).one(kTubeLevels).all(kTubeKeys);
  d.table("[classical]", "the method classical; optional").one(kClassicalLevels);
  d.table("[jerk]", "the method jerk-limited needs it; optional").one(kJerkLimit);
  return d.take();
}

}  // namespace kadr::studies
