#include "emulator/studies/point_to_point/table2.h"

#include <algorithm>
#include <cmath>

#include "emulator/studies/point_to_point/point_study.h"
#include "machine/base/numbers.h"

namespace kadr::studies {
namespace {

using planner::Mode;

constexpr double kXf = 3.5, kTf = 4, kInertia = 5.5, kCounterweight = 0.5, kKg = 9.81;  // Table 1
constexpr double kStatedOmega = 105, kOmega = 100 * kPi / 3;
constexpr int kNodes = 10'000;
constexpr double kSample_s = 4e-4, kShown_s = 6;

double four_decimals(double x) { return std::round(x * 1e4) / 1e4; }

struct PowerFigures {
  double peak_W = 0, energy_J = 0;
};

/// eta of eq. 21 on a grid of alpha; which side of a jump a node belongs to is decided as in binary64.
PowerFigures sampled_power(double xi) {
  PowerFigures out;
  const double a0 = 1 / (xi * (1 - xi));
  double before_W = 0, before_s = 0;
  for (int j = 0; j <= kNodes; ++j) {
    const double alpha = j * 1e-4;
    const bool up = alpha <= xi, cruise = !up && alpha < 1 - xi;
    const double accel = up ? a0 : cruise ? 0.0 : -a0;
    const double speed = up ? alpha * a0 : cruise ? 1 / (1 - xi) : (1 - alpha) * a0;
    const double power_W =
        kXf * kXf / (kTf * kTf * kTf) * speed * (accel * kInertia + (1 - kCounterweight) * kKg);
    const double time_s = alpha * kTf;
    out.peak_W = std::max(out.peak_W, power_W);
    if (j > 0) out.energy_J += (time_s - before_s) * (std::fabs(power_W) + std::fabs(before_W)) / 2;
    before_W = power_W;
    before_s = time_s;
  }
  out.energy_J *= kTf;  // one factor too many
  return out;
}

struct SampledVibration {
  double speed_m_s = 0, amplitude_m = 0;  // signed maxima
};

/// The base joined by lines between its samples: its speed jumps at each, and the link's speed against it.
SampledVibration sampled_vibration(double xi, const Mode& mode) {
  const planner::PointLaw law = planner::t_law(kXf, kTf, xi);
  const int samples = static_cast<int>(std::lround(kShown_s / kSample_s));
  std::vector<double> link_m(static_cast<std::size_t>(samples) + 1);
  planner::LinkState state;
  double slope_m_s = 0, base_m = 0;
  for (int i = 0; i < samples; ++i) {
    const double next_m = law.at((i + 1) * kSample_s).position_u, next_slope = (next_m - base_m) / kSample_s;
    state.link_u_s -= next_slope - slope_m_s;
    state = planner::advance_link(state, mode, 0, 0, kSample_s);
    base_m = next_m;
    slope_m_s = next_slope;
    link_m[static_cast<std::size_t>(i) + 1] = state.link_u;
  }
  SampledVibration out{-1, -1};
  for (std::size_t i = 1; i + 1 < link_m.size(); ++i) {
    const double time_s = static_cast<double>(i) * kSample_s;
    if (time_s >= kTf - 1e-9) out.amplitude_m = std::max(out.amplitude_m, link_m[i]);
    if (time_s > kTf + 1.5 * kSample_s)
      out.speed_m_s = std::max(out.speed_m_s, (link_m[i + 1] - link_m[i - 1]) / (2 * kSample_s));
  }
  return out;
}

/// xi of T1 and T3: zeros by n alone, in a motion that lasts 1 instead of tf.
std::vector<double> zeros_without_tf(double zeta) {
  const planner::XiRange range = planner::xi_range({kXf, 3, 1}, kTf);
  std::vector<double> out;
  const double omega = zeta == 0.0 ? kOmega : kStatedOmega, period = 2 * kPi / omega;
  const Mode mode{omega, zeta};
  const auto end_speed = [&](double xi) {
    return planner::link_at(planner::t_law(1, 1, xi), {mode, 1}, 1).link_u_s;
  };
  for (int n = 1; n * period <= range.high; ++n) {
    double low = n * period, high = low + period / 8;
    if (low < range.low) continue;
    if (zeta > 0.0) {
      // the damped zero lies a little above n periods; halved to the last bit
      constexpr int kBits = 60;
      const bool sign = end_speed(low) > 0;
      for (int i = 0; i < kBits; ++i) {
        const double middle = (low + high) / 2;
        ((end_speed(middle) > 0) == sign ? low : high) = middle;
      }
    }
    out.push_back(four_decimals(low));
  }
  return out;
}

}  // namespace

bool Table2Row::agrees(std::size_t column) const {
  return std::fabs(four_decimals(paper[column]) - printed[column]) < 1e-9;
}

std::vector<Table2Row> table2() {
  std::vector<Table2Row> rows = {
      {0, "T1", {.3600, .9494, 1.3672, 8.6039, 47.6920, 0, 0}},
      {0, "T2", {.3333, .9844, 1.3124, 8.5116, 45.4043, .0236, .2256}},
      {0, "T3", {.4800, .8764, 1.6827, 9.9143, 63.4446, 0, 0}},
      {.005, "T1", {.3601, .9493, 1.3674, 8.6044, 47.7012, .0045, .0437}},
      {.005, "T2", {.3333, .9844, 1.3124, 8.5116, 45.4043, .0180, .1735}},
      {.005, "T3", {.4803, .8764, 1.6837, 9.9218, 63.5128, .0063, .0607}},
  };
  planner::Load printed_load;
  printed_load.gravity_m_s2 = planner::printed_gravity_m_s2(kXf, kTf);
  for (Table2Row& row : rows) {
    double xi = four_decimals(1.0 / 3);
    if (row.law != "T2") {
      const std::vector<double> zeros = zeros_without_tf(row.zeta);
      const auto [least, most] = std::minmax_element(zeros.begin(), zeros.end(), [&](double a, double b) {
        return planner::t_law_energy_J(kXf, kTf, a, printed_load) <
               planner::t_law_energy_J(kXf, kTf, b, printed_load);
      });
      xi = row.law == "T1" ? *least : *most;
    }
    const planner::PointLaw law = planner::t_law(kXf, kTf, xi);
    const PowerFigures power = sampled_power(xi);
    const SampledVibration shaken =
        sampled_vibration(xi, row.zeta == 0.0 ? Mode{kOmega, 0} : Mode{kStatedOmega, row.zeta / 2});
    row.paper = {xi,
                 law.peak_accel_u_s2(),
                 law.peak_speed_u_s(),
                 power.peak_W,
                 power.energy_J,
                 shaken.speed_m_s,
                 1e3 * shaken.amplitude_m};
    const planner::Work work = planner::work_of(law, {});
    const Mode mode{kOmega, row.zeta};
    const auto peaks = planner::residual_peaks(planner::link_at(law, {mode, 1}, kTf), mode);
    row.physics = {xi,
                   law.peak_accel_u_s2(),
                   law.peak_speed_u_s(),
                   work.peak_W,
                   work.absolute_J,
                   peaks.link_u_s,
                   1e3 * peaks.link_u};
  }
  return rows;
}

}  // namespace kadr::studies
