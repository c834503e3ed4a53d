#include <array>
#include <cmath>

#include "plant/integrator.h"
#include "plant/linear_response.h"
#include "plant/spline.h"

namespace kadr::plant {

namespace {

constexpr ControlTicks kLookAhead{3};         // ticks of the smooth command known beyond the current one
constexpr std::size_t kRing = 4;              // pieces kept, a power of two > kLookAhead
constexpr ControlTicks kRestartTicks{16384};  // time is rebased: theta stays exact to 1e-11
constexpr double kRestartRatio = 3.5e13;      // position over tolerance: a rounding stays below 1/256 of it
constexpr double kCredibleSteps = 2;          // a command further off the lattice is not used

/// The staircase of steps is u = s + r. s, a spline through the command some ticks late, is smooth, and CVODE
/// integrates the response to it: it never meets a jump, is not restarted while the axes move, and may look
/// ahead (the delay is what makes the spline known there). The response to r = u - s is known in closed form:
///
///   z_r(T) = Phi z_r(0) + sum_i d_i R[T - t_i] - sum_q P_q c_q
///
/// The sum of the two is the response to u, exact at tick ends whatever s is. While s rests on all axes CVODE
/// is parked: its state is handed to the closed form, which then carries everything.
class Smooth final : public Integrator {
 public:
  Smooth(const std::vector<AxisMotion*>& axes, double tolerance_um) {
    std::vector<std::pair<AxisEquations, std::shared_ptr<const LinearResponse>>> known;
    for (AxisMotion* motion : axes) {
      Axis axis;
      axis.motion = motion;
      axis.response = LinearResponse::shared(motion->equations, known);
      axis.restart_m = local_tolerance(motion->equations, tolerance_um)[kLag] * kRestartRatio;
      axis_.push_back(std::move(axis));
    }
    std::vector<double> tolerance;
    for (const Axis& axis : axis_) {
      const Vector4 one = local_tolerance(axis.motion->equations, tolerance_um);
      tolerance.insert(tolerance.end(), one.begin(), one.end());
    }
    y_.assign(tolerance.size(), 0.0);
    cvode_ = std::make_unique<Cvode>(tolerance, equations, this);
    cvode_->set_max_step(static_cast<double>(kLookAhead.value));
    reset();
  }

  void reset() override {
    tick_ = {};
    running_ = false;
    for (Axis& axis : axis_) {
      axis.residual = {};
      axis.point.fill({axis.motion->node, 0});
      axis.frame_node = axis.motion->node;
      for (SplinePiece& piece : axis.piece) piece = spline_piece(axis.point, axis.motion->equations.step_m);
    }
  }

  Outcome advance(const StepBatch& batch) override {
    bool begins = false, rests = true;
    for (Axis& axis : axis_) {
      take_command(axis, batch.axis[static_cast<std::size_t>(axis.motion->axis)]);
      begins = begins || !axis.piece[slot(tick_)].constant;
      for (const SplinePiece& piece : axis.piece) rests = rests && piece.constant;
    }
    if (running_ && rests) park();
    if (!running_ && begins) {
      if (auto outcome = start_from_rest(); !outcome) return outcome;
    }
    if (running_) {
      if (auto outcome = integrate(); !outcome) return outcome;
    }
    for (std::size_t a = 0; a < axis_.size(); ++a) {
      finish(axis_[a], a, batch.axis[static_cast<std::size_t>(axis_[a].motion->axis)]);
    }
    ++tick_;
    return {};
  }

 private:
  struct Axis {
    AxisMotion* motion = nullptr;
    std::shared_ptr<const LinearResponse> response;
    Vector4 residual{};                                 // z_r at the last tick's end
    std::array<SplinePoint, 6> point{};                 // newest last
    std::array<SplinePiece, kRing> piece{};             // of tick k at k modulo kRing
    std::array<std::array<double, 6>, kRing> framed{};  // the same, from frame_node, for CVODE
    Steps frame_node;                                   // CVODE's x0 is counted from here
    double restart_m = 0;
  };

  static std::size_t slot(ControlTicks tick) { return static_cast<std::size_t>(tick.value) & (kRing - 1); }

  static double from_node(const SplinePiece& piece, Steps node, double step_m) {
    return piece.c[0] + static_cast<double>((piece.node - node).value) * step_m;
  }
  static void frame_piece(Axis& axis, std::size_t at) {
    axis.framed[at] = axis.piece[at].c;
    axis.framed[at][0] = from_node(axis.piece[at], axis.frame_node, axis.motion->equations.step_m);
  }

  // the command at this tick's end becomes the newest point of the spline, which reaches kLookAhead ticks ahead
  void take_command(Axis& axis, const AxisPulses& pulses) {
    const AxisMotion& motion = *axis.motion;
    SplinePoint newest{motion.node + pulses.net_steps(), 0};
    const double off_u = pulses.command.position_end_u -
                         (motion.origin_u + static_cast<double>(newest.node.value) * motion.step_u);
    if (std::fabs(off_u) <= kCredibleSteps * motion.step_u)
      newest.rest_m = off_u * motion.equations.metre_per_unit;
    for (std::size_t j = 0; j + 1 < axis.point.size(); ++j) axis.point[j] = axis.point[j + 1];
    axis.point.back() = newest;
    const std::size_t at = slot(tick_ + kLookAhead);
    axis.piece[at] = spline_piece(axis.point, motion.equations.step_m);
    frame_piece(axis, at);
  }

  // at rest the response to s is s itself
  void park() {
    for (std::size_t a = 0; a < axis_.size(); ++a) {
      Axis& axis = axis_[a];
      for (std::size_t i = 0; i < 4; ++i) axis.residual[i] += y_[4 * a + i];
      axis.residual[kLag] -= axis.framed[slot(tick_)][0];
    }
    running_ = false;
  }

  Outcome start_from_rest() {
    for (std::size_t a = 0; a < axis_.size(); ++a) {
      Axis& axis = axis_[a];
      move_frame(axis);
      y_[4 * a] = axis.framed[slot(tick_)][0];
      for (std::size_t i = 1; i < 4; ++i) y_[4 * a + i] = 0;
    }
    running_ = true;
    return start();
  }

  static void move_frame(Axis& axis) {
    axis.frame_node = axis.motion->node;
    for (std::size_t at = 0; at < kRing; ++at) frame_piece(axis, at);
  }

  Outcome start() {
    start_tick_ = tick_;
    return cvode_->start(0, y_.data());
  }

  Outcome integrate() {
    bool far = tick_ - start_tick_ >= kRestartTicks;
    for (std::size_t a = 0; a < axis_.size(); ++a) far = far || std::fabs(y_[4 * a]) > axis_[a].restart_m;
    if (far) {
      for (std::size_t a = 0; a < axis_.size(); ++a) {
        Axis& axis = axis_[a];
        y_[4 * a] -=
            static_cast<double>((axis.motion->node - axis.frame_node).value) * axis.motion->equations.step_m;
        move_frame(axis);
      }
      if (auto outcome = start(); !outcome) return outcome;
    }
    return cvode_->advance(static_cast<double>((tick_ + ControlTicks{1} - start_tick_).value), y_.data());
  }

  void finish(Axis& axis, std::size_t a, const AxisPulses& pulses) {
    AxisMotion& motion = *axis.motion;
    const double step_m = motion.equations.step_m;
    const SplinePiece& s = axis.piece[slot(tick_)];
    Vector4 residual = axis.response->whole_tick * axis.residual;
    const Vector4 staircase = axis.response->pulses(pulses);
    const double constant = from_node(s, motion.node, step_m);
    for (std::size_t i = 0; i < 4; ++i) {
      double smooth = axis.response->monomial[0][i] * constant;
      if (!s.constant) {
        for (std::size_t q = 1; q < 6; ++q) smooth += axis.response->monomial[q][i] * s.c[q];
      }
      residual[i] += staircase[i] - smooth;
    }
    axis.residual = residual;
    motion.move_node(pulses.net_steps());
    motion.z = residual;
    if (running_) {
      for (std::size_t i = 0; i < 4; ++i) motion.z[i] += y_[4 * a + i];
      motion.z[kLag] -= static_cast<double>((motion.node - axis.frame_node).value) * step_m;
    } else {
      motion.z[kLag] += from_node(s, motion.node, step_m);
    }
    motion.motor_force_N = motion.equations.motor_force_N(motion.z);
  }

  // response to s alone; x0 is counted from frame_node
  static void equations(const void* self, double t, const double* y, double* dydt) {
    const Smooth& group = *static_cast<const Smooth*>(self);
    ControlTicks tick = ControlTicks{static_cast<std::int64_t>(t)} + group.start_tick_;
    const ControlTicks last = group.tick_ + kLookAhead;
    if (tick > last) tick = last;
    const double theta = t - static_cast<double>((tick - group.start_tick_).value);
    const std::size_t at = slot(tick);
    for (const Axis& axis : group.axis_) {
      const AxisEquations& eq = axis.motion->equations;
      const std::array<double, 6>& c = axis.framed[at];
      const double s =
          ((((c[5] * theta + c[4]) * theta + c[3]) * theta + c[2]) * theta + c[1]) * theta + c[0];
      const double accel = eq.a * (s - y[0]) - eq.B * y[1] + eq.p * y[2] + eq.q * y[3];
      dydt[0] = y[1];
      dydt[1] = accel;
      dydt[2] = y[3];
      dydt[3] = -accel - eq.p1 * y[2] - eq.q1 * y[3];
      y += 4;
      dydt += 4;
    }
  }

  std::vector<Axis> axis_;
  std::vector<double> y_;  // CVODE's states at the last tick's end, [4 axes]
  std::unique_ptr<Cvode> cvode_;
  ControlTicks tick_;        // since the reset
  ControlTicks start_tick_;  // CVODE's time 0
  bool running_ = false;
};

}  // namespace

std::unique_ptr<Integrator> make_smooth(const std::vector<AxisMotion*>& axes, double tolerance_um) {
  return std::make_unique<Smooth>(axes, tolerance_um);
}

}  // namespace kadr::plant
