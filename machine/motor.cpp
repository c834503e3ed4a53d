#include "machine/motor.h"

#include <algorithm>

namespace kadr::machine {

namespace {

constexpr auto kEachLaw = std::make_index_sequence<std::variant_size_v<MotorLaw>>();

/// Each word of the enumeration has its law, at the same place.
template <std::size_t... kIndex>
constexpr bool laws_complete(std::index_sequence<kIndex...>) {
  return sizeof...(kIndex) == kMotorModels.size() &&
         ((std::variant_alternative_t<kIndex, MotorLaw>::kModel == kMotorModels.words[kIndex].value) && ...);
}
static_assert(laws_complete(kEachLaw), "MotorLaw lists a law for each word of kMotorModels, in order");

template <std::size_t... kIndex>
MotorLaw law_of(const AxisModel& axis, std::index_sequence<kIndex...>) {
  MotorLaw law;
  const auto take = [&]<class Law>(std::in_place_type_t<Law>) {
    if (Law::kModel == axis.plant.motor) law = Law::of(axis);
  };
  (take(std::in_place_type<std::variant_alternative_t<kIndex, MotorLaw>>), ...);
  return law;
}

template <std::size_t... kIndex>
bool needs(MotorModel model, double TwoMassModel::*number, std::index_sequence<kIndex...>) {
  const auto asks = [&]<class Law>(std::in_place_type_t<Law>) {
    return Law::kModel == model &&
           std::find(Law::kNeeds.begin(), Law::kNeeds.end(), number) != Law::kNeeds.end();
  };
  return (asks(std::in_place_type<std::variant_alternative_t<kIndex, MotorLaw>>) || ...);
}

}  // namespace

Motor::Motor(const AxisModel& axis) : law_(law_of(axis, kEachLaw)) {
  if (!follows_command()) damping_Ns_per_m_ = axis.plant.motor_damping_Ns_per_m;
}

MotorModel Motor::model() const {
  return with_law([]<class Law>(const Law&) { return Law::kModel; });
}
bool Motor::linear() const {
  return with_law([]<class Law>(const Law&) { return Law::kLinear; });
}
bool Motor::usable() const {
  return with_law([](const auto& law) { return law.usable(); });
}
double Motor::force(double lag) const {
  return with_law([&](const auto& law) { return law.force(lag); });
}
double Motor::stiffness() const {
  return with_law([](const auto& law) { return law.stiffness(); });
}
double Motor::tooth_u() const {
  return with_law([](const auto& law) { return law.tooth_u(); });
}
double Motor::bend_per_m() const {
  return with_law([](const auto& law) { return law.bend_per_m(); });
}
Motor Motor::over(double mass_kg, double tau_s) const {
  Motor accel = *this;
  accel.law_ = with_law([&](const auto& law) { return MotorLaw(law.over(mass_kg, tau_s)); });
  return accel;
}

bool motor_needs(MotorModel model, double TwoMassModel::*number) { return needs(model, number, kEachLaw); }

}  // namespace kadr::machine
