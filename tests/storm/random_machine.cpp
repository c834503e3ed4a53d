#include "tests/storm/random_machine.h"

namespace kadr::storm {
namespace {

/// Speed, acceleration and jerk of the whole machine; its axes are near them.
struct Dynamics {
  double speed_u_s, accel_u_s2, jerk_u_s3;
  bool has_jerk;
};

class MachineDraw {
 public:
  explicit MachineDraw(Draw& draw) : d_(draw) {}

  RandomMachine make() {
    letters();
    clock();
    scale();
    std::string& text = out_.text;
    text = "format = 1\nname = \"storm\"\n";
    if (d_.chance(0.1)) text += "on_alarm = \"stop\"\n";
    text += clock_;
    feed();
    planner();
    interpolator();
    overrides();
    spindle();
    draw_motors();
    plant();
    log();
    stock();
    technology();
    for (const char letter : out_.letters) axis(letter);
    return std::move(out_);
  }

 private:
  void key(const std::string& name, double value) { out_.text += name + " = " + plain(value) + "\n"; }
  void word(const std::string& name, const std::string& value) {
    out_.text += name + " = \"" + value + "\"\n";
  }
  void table(const std::string& name) { out_.text += "\n[" + name + "]\n"; }

  void letters() {
    out_.letters = d_.pick<std::string>({"XYZ",   "XYZ",    "XYZ",     "XYZ",      "XY",        "X",
                                         "XZ",    "XYZA",   "XYZA",    "XYZC",     "XYZAB",     "XYZABC",
                                         "XYZUV", "XYZUVW", "XYZABCU", "XYZABCUV", "XYZABCUVW", "ZYX",
                                         "AX",    "UVW",    "YZB",     "A"});
    for (const char letter : out_.letters) {
      const bool either = letter >= 'U' && letter <= 'W';
      if ((letter >= 'A' && letter <= 'C') || (either && d_.chance(0.2))) out_.turning += letter;
    }
  }

  void clock() {
    const int mhz = d_.pick({1, 10, 10, 10, 16, 20, 100});
    double period_us = d_.pick({125.0, 250.0, 500.0, 1000.0, 1000.0, 1000.0, 2000.0, 4000.0});
    if (period_us * mhz > 65536) period_us = 500;
    rate_hz_ = mhz * 1e6;
    out_.scale.tau_s = period_us * 1e-6;
    if (mhz == 10 && period_us == 1000) return;
    clock_ = fmt::format("\n[clock]\nrate_hz = {}\ncontrol_period_us = {}\n", mhz * 1000000, period_us);
  }

  void scale() {
    Scale& s = out_.scale;
    s.speed_u_s = d_.decades(1, 1500);
    s.move_u = s.speed_u_s * s.tau_s * d_.real(12, 90);
    dynamics_.speed_u_s = s.speed_u_s;
    dynamics_.accel_u_s2 = s.speed_u_s / (s.tau_s * d_.decades(3, 40));
    dynamics_.jerk_u_s3 = dynamics_.accel_u_s2 / (s.tau_s * d_.decades(2, 30));
    dynamics_.has_jerk = d_.chance(0.8);
    // the step rate is at most half the base clock, with room for faster axes
    s.step_u = std::max(s.move_u / d_.decades(15, 1000), 5 * s.speed_u_s / rate_hz_);
  }

  void feed() {
    if (d_.chance(0.5)) return;
    table("feed");
    if (d_.chance(0.4)) key("max_mm_s", dynamics_.speed_u_s * d_.decades(0.2, 3));
    if (d_.chance(0.4)) key("max_acceleration_mm_s2", dynamics_.accel_u_s2 * d_.decades(0.2, 3));
    if (dynamics_.has_jerk && d_.chance(0.5)) key("max_jerk_mm_s3", dynamics_.jerk_u_s3 * d_.decades(0.2, 3));
    if (d_.chance(0.6)) key("centripetal_acceleration_mm_s2", dynamics_.accel_u_s2 * d_.decades(0.2, 3));
  }

  void planner() {
    table("planner");
    const double tau_s = out_.scale.tau_s;
    if (d_.chance(0.25)) out_.text += "whole_ticks = false\n";
    if (d_.chance(0.1)) word("axis_limits", "report");
    if (d_.chance(0.15)) word("tick_feed", "constant");
    if (d_.chance(0.3)) key("tool_change_s", tau_s * d_.whole(0, 20));
    const bool blockwise = d_.chance(0.2);
    if (blockwise) word("scheduler", "blockwise");
    if (d_.chance(0.2)) word("block_ticks", "kl");
    if (d_.chance(dynamics_.has_jerk ? 0.25 : 0.02)) word("law", "quintic");
    const std::string method = d_.pick<std::string>(
        {"scheduler", "scheduler", "scheduler", "scheduler", "tube", "certified", "jerk-limited"});
    word("method", method);
    if (method != "scheduler") {
      key("node_mm", std::max(out_.scale.move_u / d_.decades(3, 20), 0.0011));
      if (d_.chance(0.7)) out_.text += fmt::format("tube_levels = {}\n", d_.whole(10, 60));
    }
    if (!blockwise && d_.chance(0.35)) {
      word("rapid_law", d_.pick<std::string>({"t-zero", "zv", "zvd", "auto"}));
      if (d_.chance(0.3)) key("rapid_frequency_pct", d_.real(0, 20));
    }
  }

  void interpolator() {
    if (d_.chance(0.7)) return;
    table("interpolator");
    word("method", d_.pick<std::string>({"classic", "half_step", "diagonal", "extra_points",
                                         "octant_midpoint", "dda", "dda_preloaded", "dda_sequential",
                                         "dda_simultaneous", "progression", "chords", "ptp"}));
  }

  void overrides() {
    if (d_.chance(0.4)) return;
    table("override");
    word("mode", d_.pick<std::string>({"corrected+", "corrected+", "corrected", "proportional"}));
    if (d_.chance(0.3)) word("locked", "freeze");
    if (d_.chance(0.3)) word("disabled", "full");
    if (d_.chance(0.5)) word("limiter", d_.pick<std::string>({"threshold", "paper", "matched"}));
    out_.text += fmt::format("predictive = {}\n", d_.flag(0.3));
    if (d_.chance(0.3)) key("limiter_band_mm_s", dynamics_.speed_u_s * d_.decades(0.01, 0.2));
  }

  void spindle() {
    if (d_.chance(0.7)) return;
    table("spindle");
    const double tick_ms = std::max(1.0, out_.scale.tau_s * 1e3);
    key("high_load_pct", d_.real(50, 150));
    key("high_ms", tick_ms * d_.whole(1, 20));
    key("down_pct", d_.whole(1, 40));
    key("down_ms", tick_ms * d_.whole(1, 30));
    key("low_ms", tick_ms * d_.whole(1, 30));
    key("up_ms", tick_ms * d_.whole(1, 30));
    key("least_pct", d_.whole(1, 60));
  }

  void draw_motors() {
    has_plant_ = d_.chance(0.6);
    motors_ = d_.pick<std::string>({"spring", "spring", "stepper", "rigid", "mixed"});
  }

  void plant() {
    if (!has_plant_ || d_.chance(0.4)) return;
    table("plant");
    const bool linear = motors_ == "spring" || motors_ == "rigid";
    const std::string kind = d_.pick<std::string>({"smooth", "reference", linear ? "oracle" : "smooth"});
    word("integrator", kind);
    if (d_.chance(0.1)) out_.text += fmt::format("tolerance_um = {:.3e}\n", d_.decades(1e-10, 1e-5));
  }

  void log() {
    if (d_.chance(0.5)) return;
    table("log");
    if (d_.chance(0.06)) out_.text += "ticks = false\n";
    if (d_.chance(0.06)) out_.text += "steps = false\n";
    if (d_.chance(0.5)) out_.text += "energy = true\n";
    if (d_.chance(0.5)) out_.text += fmt::format("block_ticks = {}\n", d_.whole(16, 64));
    if (d_.chance(0.4)) key("viewer_rate_hz", d_.chance(0.3) ? 0 : d_.whole(1, 200));
  }

  void stock() {
    if (!d_.chance(0.5)) return;
    std::string linear;
    for (const char letter : out_.letters)
      if (!out_.rotary(letter)) linear += letter;
    if (linear.empty()) return;
    table("stock");
    word("axis", std::string(1, linear.find('Z') != std::string::npos ? 'Z' : linear.front()));
    key("position_mm", out_.scale.move_u * d_.real(-3, 1));
    if (d_.chance(0.2)) out_.text += "below = false\n";
  }

  void technology() {
    if (!d_.chance(0.1)) return;
    out_.text += "\n[[technology]]\n";
    word("on", d_.pick<std::string>({"M62 P1", "M63 P1", "M67 E0"}));
    key("max_mm_s", std::max(out_.scale.speed_u_s * d_.decades(0.05, 1), 0.001));
  }

  void axis(char letter) {
    const bool rotary = out_.rotary(letter);
    const std::string u = rotary ? "deg" : "mm";
    out_.text += "\n[[axis]]\n";
    word("name", std::string(1, letter));
    if (rotary && letter >= 'U') word("kind", "rotary");
    const double like = d_.chance(0.6) ? 1 : d_.decades(0.4, 2);
    const double step_u = d_.chance(0.7) ? out_.scale.step_u : out_.scale.step_u * d_.decades(1, 4);
    if (d_.chance(0.8))
      out_.text += fmt::format("step_{} = {:.6g}\n", u, step_u);
    else
      out_.text += fmt::format("steps_per_{} = {:.6g}\n", u, 1 / step_u);
    range(u);
    key("max_" + u + "_s", dynamics_.speed_u_s * like);
    key("max_acceleration_" + u + "_s2", dynamics_.accel_u_s2 * like);
    if (dynamics_.has_jerk)
      key("max_jerk_" + u + "_s3", dynamics_.jerk_u_s3 * like);
    else
      out_.text += "max_jerk_" + u + "_s3 = inf\n";
    if (d_.chance(0.4)) key("junction_acceleration_" + u + "_s2", dynamics_.accel_u_s2 * d_.decades(0.05, 2));
    if (d_.chance(0.2))
      key("junction_jerk_" + u + "_s3", dynamics_.accel_u_s2 / out_.scale.tau_s * d_.decades(0.05, 2));
    if (has_plant_ && d_.chance(0.85)) motor(u, rotary, step_u);
  }

  void range(const std::string& u) {
    const double move_u = out_.scale.move_u;
    const double home_u = d_.chance(0.7) ? 0 : move_u * d_.real(-2, 2);
    const double room_u = d_.chance(0.04) ? 4 * move_u : 1e4 * move_u;
    if (d_.chance(0.05))
      out_.text += "range_" + u + " = [-inf, inf]\n";
    else
      out_.text += fmt::format("range_{} = [{}, {}]\n", u, plain(-room_u), plain(room_u));
    if (home_u != 0) key("home_" + u, home_u);
    if (d_.chance(0.2)) key("home2_" + u, move_u * d_.real(-1, 1));
  }

  /// Two masses whose frequencies are between a hundredth and a third of the control rate.
  void motor(const std::string& u, bool rotary, double step_u) {
    constexpr double kTurn = 2 * kPi;
    const double tau_s = out_.scale.tau_s;
    const std::string model =
        motors_ == "mixed" ? d_.pick<std::string>({"spring", "stepper", "rigid"}) : motors_;
    const std::string mass = rotary ? "kg_m2" : "kg", damping = rotary ? "Nms_per_rad" : "Ns_per_m";
    const std::string stiffness = rotary ? "Nm_per_rad" : "N_per_m";
    out_.text += "[axis.plant]\n";
    word("model", model);
    if (model == "rigid" && d_.chance(0.4)) return;
    const double base_kg = d_.decades(0.05, 50);
    const double link_kg = base_kg * d_.decades(1e-3, 1);
    const double link_rad_s = kTurn * d_.decades(0.01, 0.3) / tau_s;
    const double motor_rad_s = kTurn * d_.decades(0.01, 0.3) / tau_s;
    const double link_N_per_m = link_kg * link_rad_s * link_rad_s;
    const double motor_N_per_m = (base_kg + link_kg) * motor_rad_s * motor_rad_s;
    const double link_ratio = d_.chance(0.2) ? 0 : d_.decades(1e-3, 0.7);
    const double motor_ratio = d_.decades(0.01, 1.2);
    const auto number = [&](const std::string& name, double value) {
      out_.text += fmt::format("{} = {:.6g}\n", name, value);
    };
    number("base_mass_" + mass, base_kg);
    number("link_mass_" + mass, link_kg);
    number("link_stiffness_" + stiffness, link_N_per_m);
    number("link_damping_" + damping, 2 * link_ratio * link_kg * link_rad_s);
    if (d_.chance(0.3)) number("base_friction_" + damping, 0.02 * base_kg * motor_rad_s);
    if (model == "rigid") return;
    if (model == "spring") number("motor_stiffness_" + stiffness, motor_N_per_m);
    number("motor_damping_" + damping, 2 * motor_ratio * (base_kg + link_kg) * motor_rad_s);
    if (model != "stepper") return;
    const double pitch_u = 4 * d_.whole(1, 32) * step_u;
    const double pitch_m = pitch_u * (rotary ? kPi / 180 : 1e-3);
    number(rotary ? "holding_force_Nm" : "holding_force_N", motor_N_per_m * pitch_m / kTurn);
    number("tooth_pitch_" + u, pitch_u);
  }

  Draw& d_;
  RandomMachine out_;
  Dynamics dynamics_{};
  std::string clock_;
  double rate_hz_ = 10e6;
  bool has_plant_ = false;
  std::string motors_;
};

}  // namespace

RandomMachine random_machine(Draw& draw) { return MachineDraw(draw).make(); }

}  // namespace kadr::storm
