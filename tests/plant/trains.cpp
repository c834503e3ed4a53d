#include "tests/plant/trains.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

namespace kadr::plant::testing {

using machine::AxisModel;
using machine::MachineModel;
using machine::MotorModel;

namespace {

constexpr double kPi_ = 3.14159265358979323846;

}  // namespace

Motion ramp_train(double rate_hz, double total_s, double ramp_s) {
  const auto ramp = [=](double t) {
    return 0.5 * rate_hz * (t - ramp_s / kPi_ * std::sin(kPi_ * t / ramp_s));
  };
  const auto ramp_speed = [=](double t) { return 0.5 * rate_hz * (1 - std::cos(kPi_ * t / ramp_s)); };
  const double end = 2 * ramp(ramp_s) + rate_hz * (total_s - 2 * ramp_s);
  const auto steps = [=](double t) {
    if (t <= 0) return 0.0;
    if (t < ramp_s) return ramp(t);
    if (t < total_s - ramp_s) return ramp(ramp_s) + rate_hz * (t - ramp_s);
    return t < total_s ? end - ramp(total_s - t) : end;
  };
  const auto speed = [=](double t) {
    if (t <= 0 || t >= total_s) return 0.0;
    if (t < ramp_s) return ramp_speed(t);
    return t < total_s - ramp_s ? rate_hz : ramp_speed(total_s - t);
  };
  return {steps, speed};
}

Motion swing(double amplitude_steps, double frequency_hz) {
  const double w = 2 * kPi_ * frequency_hz;
  return {[=](double t) { return amplitude_steps * (1 - std::cos(w * t)) / 2; },
          [=](double t) { return amplitude_steps * w * std::sin(w * t) / 2; }};
}

std::vector<StepBatch> pulse_batches(const MachineModel& machine, const std::vector<Motion>& motion,
                                     std::int64_t ticks) {
  const double base_s = 1 / static_cast<double>(machine.clock.base_hz);
  const std::int64_t tau = machine.clock.control_tick.value;
  std::vector<StepBatch> batches(static_cast<std::size_t>(ticks));
  for (std::int64_t k = 0; k < ticks; ++k) {
    StepBatch& batch = batches[static_cast<std::size_t>(k)];
    batch.tick = {k};
    batch.axis.resize(motion.size());
  }
  for (std::size_t a = 0; a < motion.size(); ++a) {
    const AxisModel& axis = machine.axis[a];
    std::int64_t node = 0;
    for (std::int64_t k = 0; k < ticks; ++k) {
      AxisPulses& pulses = batches[static_cast<std::size_t>(k)].axis[a];
      const double begin_s = static_cast<double>(k * tau) * base_s,
                   end_s = static_cast<double>((k + 1) * tau) * base_s;
      pulses.command = {axis.home_u + axis.step_u * motion[a].steps(begin_s),
                        axis.home_u + axis.step_u * motion[a].steps(end_s),
                        axis.step_u * motion[a].steps_s(begin_s), axis.step_u * motion[a].steps_s(end_s)};
      // the tick is cut finely enough that the motion is monotonic in each piece
      const int pieces = 4;
      int sign = 0;
      std::int64_t last = 0;
      for (int p = 0; p < pieces; ++p) {
        const double low_s = begin_s + (end_s - begin_s) * p / pieces;
        const double high_s = begin_s + (end_s - begin_s) * (p + 1) / pieces;
        const double target = motion[a].steps(high_s);
        while (std::fabs(target - static_cast<double>(node)) > 0.5) {
          const int direction = target > static_cast<double>(node) ? 1 : -1;
          const double level = static_cast<double>(node) + 0.5 * direction;
          double low = low_s, high = high_s;
          for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (low + high);
            ((motion[a].steps(middle) - level) * direction < 0 ? low : high) = middle;
          }
          std::int64_t offset = static_cast<std::int64_t>((high - begin_s) / base_s);
          offset = std::min(std::max(offset, last), tau - 1);
          last = offset;
          if (sign == 0) {
            pulses.first_sign = static_cast<std::int8_t>(direction);
          } else if (sign != direction) {
            pulses.reversals.push_back(static_cast<std::uint16_t>(pulses.offset_ticks.size()));
          }
          sign = direction;
          pulses.offset_ticks.push_back(static_cast<std::uint16_t>(offset));
          node += direction;
        }
      }
    }
  }
  return batches;
}

AxisModel make_axis(const AxisRecipe& r) {
  AxisModel axis;
  axis.kind = r.kind;
  axis.step_u = r.step_u;
  axis.has_plant = true;
  machine::TwoMassModel& m = axis.plant;
  m.motor = r.motor;
  m.base_mass_kg = r.base_kg;
  m.link_mass_kg = r.link_kg;
  const double link = 2 * kPi_ * r.link_hz, motor = 2 * kPi_ * r.motor_hz, all_kg = r.base_kg + r.link_kg;
  m.link_stiffness_N_per_m = r.link_kg * link * link;
  m.link_damping_Ns_per_m = 2 * r.link_ratio * link * r.link_kg;
  m.motor_stiffness_N_per_m = all_kg * motor * motor;
  // the losses shared between motor and guide
  m.motor_damping_Ns_per_m = 1.5 * r.motor_ratio * motor * all_kg;
  m.base_friction_Ns_per_m = 0.5 * r.motor_ratio * motor * all_kg;
  m.tooth_pitch_u = r.pitch_steps * r.step_u;
  const double metre_per_unit = r.kind == machine::AxisKind::rotary ? kPi_ / 180 : 1e-3;
  // the same stiffness at small angles: F_hold 2 pi / pitch = Km
  m.holding_force_N = m.motor_stiffness_N_per_m * m.tooth_pitch_u * metre_per_unit / (2 * kPi_);
  return axis;
}

MachineModel make_machine(const std::vector<AxisRecipe>& axes, double tau_ms, std::int64_t base_hz) {
  MachineModel machine;
  machine.clock.base_hz = base_hz;
  machine.clock.control_tick = {
      static_cast<std::int64_t>(std::floor(static_cast<double>(base_hz) * tau_ms / 1000 + 0.5))};
  for (const AxisRecipe& recipe : axes) machine.axis.push_back(make_axis(recipe));
  return machine;
}

namespace {

using Long4 = std::array<long double, 4>;

struct LongEquations {
  machine::TwoMassModel m;
  long double pitch_m;
  Long4 slope(const Long4& y) const {
    long double force = -m.motor_damping_Ns_per_m * y[1];
    if (m.motor == MotorModel::stepper) {
      force -= m.holding_force_N * std::sin(2 * 3.14159265358979323846264338L * y[0] / pitch_m);
    } else {
      force -= m.motor_stiffness_N_per_m * y[0];
    }
    const long double link_force = m.link_stiffness_N_per_m * y[2] + m.link_damping_Ns_per_m * y[3];
    const long double base = (force - m.base_friction_Ns_per_m * y[1] + link_force) / m.base_mass_kg;
    return {y[1], base, y[3], -base - link_force / m.link_mass_kg};
  }
};

// e^{At} y by the series of its action, cut so that each part converges fast
void advance_linear(const LongEquations& eq, Long4& y, long double t_s, long double part_s) {
  const int parts = static_cast<int>(std::ceil(t_s / part_s));
  const long double h = t_s / parts;
  for (int p = 0; p < parts; ++p) {
    Long4 term = y;
    for (int n = 1; n < 60; ++n) {
      term = eq.slope(term);
      long double size = 0;
      for (int i = 0; i < 4; ++i) {
        term[i] *= h / n;
        y[i] += term[i];
        size += std::fabs(term[i]);
      }
      if (size < 1e-30L) break;
    }
  }
}

void advance_runge_kutta(const LongEquations& eq, Long4& y, long double t_s, long double part_s) {
  const int parts = static_cast<int>(std::ceil(t_s / part_s));
  const long double h = t_s / parts;
  const auto moved = [&](const Long4& slope, long double by) {
    Long4 at = y;
    for (int i = 0; i < 4; ++i) at[i] += by * slope[i];
    return at;
  };
  for (int p = 0; p < parts; ++p) {
    const Long4 k1 = eq.slope(y), k2 = eq.slope(moved(k1, h / 2)), k3 = eq.slope(moved(k2, h / 2)),
                k4 = eq.slope(moved(k3, h));
    for (int i = 0; i < 4; ++i) y[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
}

}  // namespace

std::vector<ExactState> exact_states(const AxisModel& axis, const machine::ClockModel& clock, int index,
                                     const std::vector<StepBatch>& batches, double rk_us) {
  const long double metre_per_unit =
      axis.kind == machine::AxisKind::rotary ? 3.14159265358979323846264338L / 180 : 1e-3L;
  const LongEquations eq{axis.plant, axis.plant.tooth_pitch_u * metre_per_unit};
  const machine::TwoMassModel& m = axis.plant;
  const long double fastest =
      std::sqrt(m.motor_stiffness_N_per_m / m.base_mass_kg) +
      std::sqrt(m.link_stiffness_N_per_m * (1 / m.base_mass_kg + 1 / m.link_mass_kg)) +
      (m.motor_damping_Ns_per_m + m.base_friction_Ns_per_m + m.link_damping_Ns_per_m) / m.base_mass_kg +
      m.link_damping_Ns_per_m / m.link_mass_kg;
  const long double base_s = 1.0L / clock.base_hz;
  Long4 y{};
  std::vector<ExactState> states;
  const auto advance = [&](std::int64_t base_ticks) {
    if (base_ticks == 0) return;
    if (m.motor == MotorModel::stepper) {
      advance_runge_kutta(eq, y, base_ticks * base_s, rk_us * 1e-6L);
    } else {
      advance_linear(eq, y, base_ticks * base_s, 2 / fastest);
    }
  };
  for (const StepBatch& batch : batches) {
    std::int64_t now = 0;
    batch.axis[static_cast<std::size_t>(index)].for_each([&](std::uint16_t offset, int sign) {
      advance(offset - now);
      now = offset;
      y[0] -= sign * static_cast<long double>(axis.step_u) * metre_per_unit;
    });
    advance(clock.control_tick.value - now);
    states.push_back({y[0], y[1], y[2], y[3]});
  }
  return states;
}

std::uint64_t property_seed() {
  const char* text = std::getenv("KADR_SEED");
  return text ? std::stoull(text) : 1;
}

int property_count(int normal) {
  const char* text = std::getenv("KADR_COUNT");
  return text ? std::stoi(text) : normal;
}

double Random::next() {
  state_ += 0x9e3779b97f4a7c15u;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

double Random::log_between(double low, double high) { return low * std::pow(high / low, next()); }

}  // namespace kadr::plant::testing
