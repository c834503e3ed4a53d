#pragma once
#include <array>
#include <cstddef>
#include <utility>
#include <variant>

#include "machine/axis.h"

/// The motors of kMotorModels as laws: the force [N, or N m] that pulls the base back to its equilibrium, by
/// the lag [m, or rad] of the base relative to it. The plant's equations, its Taylor series and energies, and
/// the planner's rapids ask the same law. Damping (bm) is no part of it: Motor keeps that.
///
/// A law has
///   kModel, kLinear, kNeeds    its word, whether force is proportional to lag, and the keys that it requires
///   of(axis)                   its numbers
///   force(lag), stiffness()    -dforce/dlag at rest
///   tooth_u()                  distance of one equilibrium to the next, axis units; 0 if there is one alone
///   bend_per_m()               how fast the law bends with the lag; 0 if it is linear
///   over(mass, tau)            the same law as an acceleration, m per control tick squared
///   Series                     Taylor coefficients of the force along a motion, each times its power of the
///   step
namespace kadr::machine {

template <std::size_t kCount>
using MotorNeeds = std::array<double TwoMassModel::*, kCount>;

/// A time step's share of a series: coefficients 0 to n of lag and speed are known when coefficient n of the
/// force is asked for.
template <std::size_t kSize>
struct MotionSeries {
  const std::array<double, kSize>& lag;
  const std::array<double, kSize>& speed;
};

/// The base is where the command is: there is no lag to pull by.
struct RigidMotor {
  static constexpr MotorModel kModel = MotorModel::rigid;
  static constexpr bool kLinear = true;
  static constexpr MotorNeeds<0> kNeeds{};

  static RigidMotor of(const AxisModel&) { return {}; }
  RigidMotor over(double, double) const { return {}; }
  bool usable() const { return true; }
  double force(double) const { return 0; }
  double stiffness() const { return 0; }
  double tooth_u() const { return 0; }
  double bend_per_m() const { return 0; }

  template <std::size_t kSize>
  struct Series {
    Series(const RigidMotor&, MotionSeries<kSize>) {}
    double force(std::size_t) const { return 0; }
    void advance(std::size_t, double) {}
  };
};

/// F = -Km lag.
struct SpringMotor {
  static constexpr MotorModel kModel = MotorModel::spring;
  static constexpr bool kLinear = true;
  static constexpr MotorNeeds<2> kNeeds{&TwoMassModel::motor_stiffness_N_per_m,
                                        &TwoMassModel::motor_damping_Ns_per_m};
  double slope = 0;  ///< Km [N/m]; after over() per tick squared

  static SpringMotor of(const AxisModel& axis) { return {axis.plant.motor_stiffness_N_per_m}; }
  SpringMotor over(double mass_kg, double tau_s) const { return {slope * (tau_s * tau_s) / mass_kg}; }
  bool usable() const { return slope > 0 && slope < kInfinity; }
  double force(double lag_m) const { return -slope * lag_m; }
  double stiffness() const { return slope; }
  double tooth_u() const { return 0; }
  double bend_per_m() const { return 0; }

  template <std::size_t kSize>
  struct Series {
    Series(const SpringMotor& law, MotionSeries<kSize> motion) : law_(law), motion_(motion) {}
    double force(std::size_t n) const { return law_.force(motion_.lag[n]); }
    void advance(std::size_t, double) {}

   private:
    const SpringMotor& law_;
    MotionSeries<kSize> motion_;
  };
};

/// F = -F_hold sin(kappa lag), kappa = 2 pi / pitch.
struct StepperMotor {
  static constexpr MotorModel kModel = MotorModel::stepper;
  static constexpr bool kLinear = false;
  static constexpr MotorNeeds<3> kNeeds{&TwoMassModel::motor_damping_Ns_per_m, &TwoMassModel::holding_force_N,
                                        &TwoMassModel::tooth_pitch_u};
  double peak = 0;  ///< F_hold [N]; after over() m per tick squared
  double pitch_u = 0;
  double pitch_m = 0;
  double kappa_per_m = 0;

  static StepperMotor of(const AxisModel& axis) {
    const double pitch_m = axis.plant.tooth_pitch_u * axis.si_per_u();
    return {axis.plant.holding_force_N, axis.plant.tooth_pitch_u, pitch_m, 2 * kPi / pitch_m};
  }
  StepperMotor over(double mass_kg, double tau_s) const {
    StepperMotor accel = *this;
    accel.peak = peak * (tau_s * tau_s) / mass_kg;
    return accel;
  }
  bool usable() const { return peak > 0 && peak < kInfinity && kappa_per_m > 0 && kappa_per_m < kInfinity; }
  double force(double lag_m) const { return -peak * exact_sincos(kappa_per_m * lag_m).sin; }
  double stiffness() const { return peak * 2 * kPi / pitch_m; }
  double tooth_u() const { return pitch_u; }
  double bend_per_m() const { return kappa_per_m; }

  /// s = sin(kappa lag), c = cos(kappa lag):   s' = kappa v c,   c' = -kappa v s.
  template <std::size_t kSize>
  struct Series {
    Series(const StepperMotor& law, MotionSeries<kSize> motion) : law_(law), speed_(motion.speed) {
      const SinCos angle = exact_sincos(law.kappa_per_m * motion.lag[0]);
      sine_[0] = angle.sin;
      cosine_[0] = angle.cos;
    }
    double force(std::size_t n) const { return -law_.peak * sine_[n]; }
    void advance(std::size_t n, double over) {
      double sine = 0, cosine = 0;
      for (std::size_t j = 0; j <= n; ++j) {
        sine += speed_[j] * cosine_[n - j];
        cosine += speed_[j] * sine_[n - j];
      }
      sine_[n + 1] = over * law_.kappa_per_m * sine;
      cosine_[n + 1] = -over * law_.kappa_per_m * cosine;
    }

   private:
    const StepperMotor& law_;
    const std::array<double, kSize>& speed_;
    std::array<double, kSize> sine_, cosine_;
  };
};

/// The laws in the order of their words; a new one is added here.
using MotorLaw = std::variant<RigidMotor, SpringMotor, StepperMotor>;

/// The motor of one axis.
class Motor {
 public:
  Motor() = default;  ///< rigid
  explicit Motor(const AxisModel& axis);

  MotorModel model() const;
  /// Prescribes the base's motion, whatever the load does, from the command and not from the pulses.
  bool follows_command() const { return model() == MotorModel::rigid; }
  /// Whether force is proportional to lag: closed forms and superposition hold.
  bool linear() const;
  /// False if a number of the law makes it meaningless.
  bool usable() const;
  /// Force [N, N m] at a lag [m, rad], without damping.
  double force(double lag) const;
  /// -dforce/dlag at rest [N/m, N m/rad].
  double stiffness() const;
  /// bm [N s/m, N m s/rad]; 0 of a motor that follows its command.
  double damping_Ns_per_m() const { return damping_Ns_per_m_; }
  /// Distance from one equilibrium to the next: a motor that lags by more than half of it loses steps. Axis
  /// units; 0 if there is one alone.
  double tooth_u() const;
  double bend_per_m() const;
  /// The same force per mass, in m per control tick squared.
  Motor over(double mass_kg, double tau_s) const;
  /// Calls use(law) with the law's own type, for loops that must not ask for it at every step.
  template <class Use>
  decltype(auto) with_law(Use&& use) const {
    return std::visit(std::forward<Use>(use), law_);
  }

 private:
  MotorLaw law_;
  double damping_Ns_per_m_ = 0;
};

/// Whether a motor requires that number.
bool motor_needs(MotorModel model, double TwoMassModel::*number);

}  // namespace kadr::machine
