#include "machine/file/machine_keys.h"

#include <tuple>
#include <utility>
#include <variant>

namespace kadr::machine {

namespace {

/// Whether a number of the plant has a key that is required by motors.
constexpr bool is_motor_key(double TwoMassModel::*number) {
  return std::apply(
      [&](const auto&... each) { return ((each.member == number && each.need == Need::motor) || ...); },
      kPlantKeys);
}
template <std::size_t... kIndex>
constexpr bool motor_keys_declared(std::index_sequence<kIndex...>) {
  const auto declared = []<class Law>(std::in_place_type_t<Law>) {
    for (const auto number : Law::kNeeds)
      if (!is_motor_key(number)) return false;
    return true;
  };
  return (declared(std::in_place_type<std::variant_alternative_t<kIndex, MotorLaw>>) && ...);
}
static_assert(motor_keys_declared(std::make_index_sequence<std::variant_size_v<MotorLaw>>()),
              "each number that a motor needs has a key with .required(Need::motor)");

// the motor's word and numbers alone
static_assert(sizeof(TwoMassModel) == (1 + std::tuple_size_v<decltype(kPlantKeys)>)*sizeof(double),
              "each number of TwoMassModel has its key");

}  // namespace

std::vector<TableDocument> machine_keys() {
  Documents d;
  d.table("", "before all tables")
      .one(kFormat)
      .one(kName)
      .one(kProgramUnits)
      .one(kProgramStartup)
      .one(kOnAlarm);
  d.table("[clock]", "the two clocks").one(kRate).one(kControlPeriod);
  d.table("[path]", "what a path may be").all(kPathKeys).one(kApproach);
  d.table("[feed]", "limits along the path of X Y Z, on top of those of each axis").all(kFeedKeys);
  d.table("[planner]", "how feed is planned").all(kPlannerKeys);
  d.table("[interpolator]", "how steps are made").one(kInterpolatorMethod);
  d.table("[override]", "what the operator's override does").all(kOverrideKeys);
  d.table("[spindle]", "how the feed answers the spindle's load").all(kSpindleKeys);
  d.table("[plant]", "how the machine's motion is computed").one(kIntegrator).one(kTolerance);
  d.table("[log]", "what a log contains").all(kLogKeys).one(kViewerRate);
  d.table("[stock]", "material that a probe meets; optional")
      .one(kStockAxis)
      .one(kStockPosition)
      .one(kStockBelow);
  d.table("[[technology]]", "a feed for each change of an output with the motion; optional")
      .one(kTechnologyOn)
      .one(kTechnologyLimit);
  d.table("[codes]", "G and M codes of the machine's owner; optional").one(kCodesIgnored);
  d.table("[codes.M10]", "one for each code that does something, also M10 = { ... } in [codes]; optional")
      .all(kOwnerKeys)
      .one(kOwnerCall);
  d.table("[[axis]]", "one for each axis")
      .one(kAxisName)
      .one(kAxisKindKey)
      .one(kStep)
      .one(kRangeDocument)
      .one(kHome)
      .one(kHome2)
      .one(kMaxFeed)
      .all(kAxisLimitKeys)
      .all(kJunctionKeys);
  d.table("[axis.plant]", "the flexible machine; optional, an axis without it follows its steps exactly")
      .one(kMotor)
      .all(kPlantKeys);
  return d.take();
}

}  // namespace kadr::machine
