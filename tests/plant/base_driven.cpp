#include <doctest/doctest.h>

#include <cmath>

#include "plant/plant.h"
#include "tests/plant/trains.h"

using namespace kadr;
using namespace kadr::plant;
using namespace kadr::plant::testing;

namespace {

constexpr double kBasePi_ = 3.14159265358979323846;

// Paper 001's trapezoidal law: 3.5 m in 4 s, acceleration +A for xi tf, 0, -A for xi tf, with A = xf/(tf^2 xi
// (1 - xi)). The base is prescribed, so the link obeys x1'' + 2 zeta w x1' + w^2 x1 = -a(t), solved exactly
// piece by piece:
//   x1+ = xe + e^{-zeta w h} (y cos wd h + (v + zeta w y)/wd sin wd h), xe = -a/w^2, y = x1 - xe, wd = w
//   sqrt(1 - zeta^2)
// Expected values: that formula in 40 digits.
struct Case {
  double w, zeta, xi;
  double x_a, v_a, x_b, v_b, x_tf, v_tf, envelope;  // m, m/s: after acceleration, before braking, at the end
};

constexpr double kBaseW = 100 * kBasePi_ / 3;
constexpr double kThird = 1.0 / 3;

const Case kCases[] = {
    {kBaseW, 0, .36, 0, 0, 0, 0, 0, 0, 0},
    {kBaseW, 0, .3601, -7.593453105815693e-8, -3.796171393130787e-4, 3.020065693170574e-6,
     2.101230002900696e-4, 3.177375737038982e-6, 5.763122091774534e-4, 6.354751474077963e-6},
    {kBaseW, 0, .3333, -7.294774331562814e-5, -9.234049158483779e-3, -9.788914991440996e-5,
     6.208182552114504e-3, 1.128388435000749e-4, 2.046670226013603e-2, 2.256776870001498e-4},
    {kBaseW, 0, kThird, -7.417684010895094e-5, -9.257280355207747e-3, -9.993818632897214e-5,
     6.042260627540349e-3, 1.136455123471736e-4, 2.061301580433754e-2, 2.272910246943472e-4},
    {kBaseW, 0, .48, 0, 0, 0, 0, 0, 0, 0},
    {kBaseW, 0, .4803, -6.301496085463231e-7, -1.048866910949009e-3, 7.597008936480648e-6,
     6.867063084942161e-4, 8.989134336142929e-6, 1.630448614391202e-3, 1.797826867228586e-5},
    {kBaseW, 0, .33, 0, 0, 0, 0, 0, 0, 0},
    {kBaseW, .005, .36, -4.584452543378546e-5, 8.040733219449807e-6, 1.285761881258257e-5,
     -2.313225016295751e-3, 5.191341929806375e-5, -1.095202366002421e-3, 5.290578555721386e-5},
    {kBaseW, .005, .3601, -4.587146341807809e-5, -1.705370295211788e-4, 1.544888041435109e-5,
     -2.139186471282758e-3, 5.274982655671674e-5, -8.651442398819802e-4, 5.335269555266232e-5},
    {kBaseW, .005, .3333, -8.1103619379727e-5, -4.592909831937201e-3, -2.774089681045286e-5,
     3.852111273273737e-3, 9.639820658964978e-5, 6.365251915051542e-3, 1.142199208610994e-4},
    {kBaseW, .005, kThird, -8.171270306251112e-5, -4.604259187322031e-3, -2.886503710374916e-5,
     3.800839934895417e-3, 9.690144258073759e-5, 6.407132756958789e-3, 1.148605304244403e-4},
    {kBaseW, .005, .48, -5.067415278920649e-5, 7.697008657845592e-6, 2.345261355446556e-5,
     -4.229371544247221e-3, 5.929320785085513e-5, -1.553112282378515e-3, 6.10487201328829e-5},
    {kBaseW, .005, .4803, -5.089302033498671e-5, -3.759398158328502e-4, 3.532321313882976e-5,
     -3.264508381467747e-3, 6.232047164036407e-5, -9.742913517287278e-4, 6.29658857866887e-5},
    {kBaseW, .005, .33, -4.502021582110999e-5, 8.178777479871756e-6, 1.114024055036287e-5,
     -2.003083723262887e-3, 5.061797182919014e-5, -1.010719778908848e-3, 5.148314730396734e-5},
    {105, 0, .36, -6.917599645321124e-6, -3.550781835604969e-3, 3.451616098720977e-5, 2.880643311422897e-5,
     3.876886978431416e-5, 2.154095429252042e-3, 4.386226706822624e-5},
    {105, 0, .3601, -8.406316878653074e-6, -3.896342177152698e-3, 3.795255615990017e-5, 2.832052098785264e-4,
     4.381603830983067e-5, 2.434528743711952e-3, 4.957252519636287e-5},
    {105, 0, .3333, -1.05725936972832e-4, -9.215269219783443e-3, -6.170316903452967e-5, 1.289120140207109e-2,
     2.377592242562208e-4, 1.321049752242337e-2, 2.689956826257564e-4},
    {105, 0, kThird, -1.069476405360954e-4, -9.18974680725292e-3, -6.463625052455782e-5, 1.282546012752695e-2,
     2.394671365251868e-4, 1.330539340235515e-2, 2.709279779051199e-4},
    {105, 0, .48, -1.123231467798313e-5, -4.277509044219267e-3, 4.133235365441081e-5, 9.237664411361572e-4,
     5.123305926725997e-5, 2.846636990146553e-3, 5.796398349512973e-5},
    {105, 0, .4803, -1.689207934978175e-5, -5.144045138652857e-3, 4.775631522732021e-5, 2.112524795917059e-3,
     6.689977098635146e-5, 3.717118701201194e-3, 7.568896483522884e-5},
    {105, 0, .33, -6.07037865156143e-6, -3.406677477792226e-3, 3.29777472364027e-5, -1.472375829717592e-4,
     3.631036998686892e-5, 2.017495027797044e-3, 4.108077317112136e-5},
    {105, .005, .36, -4.882046121154304e-5, -1.659875016366243e-3, 1.440254000997603e-5,
     -2.595264615457037e-3, 5.052080595371209e-5, 2.630534442757094e-4, 5.059602650881492e-5},
    {105, .005, .3601, -4.951094763345104e-5, -1.821886494659071e-3, 1.736014979113348e-5,
     -2.474140106117697e-3, 5.214078931495499e-5, 4.080432605594043e-4, 5.230543510307423e-5},
    {105, .005, .3333, -9.71582244439484e-5, -4.57803751356948e-3, -1.055566165769788e-5,
     5.456271835335221e-3, 1.234626056480099e-4, 4.611804582040757e-3, 1.312509443657027e-4},
    {105, .005, kThird, -9.776290688261421e-5, -4.565154903645365e-3, -1.188938719925998e-5,
     5.454258139597193e-3, 1.241865034631634e-4, 4.628644494043935e-3, 1.319875719531612e-4},
    {105, .005, .48, -5.446951374347959e-5, -1.554491896036227e-3, 3.538309444663576e-5,
     -4.014474340078655e-3, 5.848693110517248e-5, -3.936423061880064e-4, 5.858898424979563e-5},
    {105, .005, .4803, -5.652438807859781e-5, -1.870100179439085e-3, 4.713985107293143e-5,
     -2.925071258530395e-3, 6.390108623638739e-5, -7.743830995162532e-5, 6.390245341508234e-5},
    {105, .005, .33, -4.778967119338177e-5, -1.69599676057596e-3, 1.130727212682251e-5, -2.316414916162976e-3,
     4.910451661443566e-5, 4.036390830693462e-4, 4.927453349925096e-5},
};

struct Law {
  double accel_mm_s2, xi_s;
  double speed(double t) const {
    if (t <= xi_s) return accel_mm_s2 * t;
    return t <= 4 - xi_s ? accel_mm_s2 * xi_s : accel_mm_s2 * (4 - t);
  }
  double position(double t) const {
    if (t <= xi_s) return accel_mm_s2 * t * t / 2;
    if (t <= 4 - xi_s) return accel_mm_s2 * xi_s * (t - xi_s / 2);
    return 3500 - accel_mm_s2 * (4 - t) * (4 - t) / 2;
  }
};

}  // namespace

TEST_CASE("the base-driven link matches 28 closed-form responses to 1e-8, zeros to 1e-10 m") {
  for (const Case& c : kCases) {
    CAPTURE(c.w);
    CAPTURE(c.zeta);
    CAPTURE(c.xi);
    // corners of the law fall on control ticks: 12000 of 1/3 ms, or 10000 of 0.4 ms
    const bool thirds = c.xi == kThird;
    machine::MachineModel model;
    model.clock.base_hz = thirds ? 3'000'000 : 10'000'000;
    model.clock.control_tick = {thirds ? 1000 : 4000};
    const std::int64_t ticks = thirds ? 12000 : 10000;
    const auto corner = static_cast<std::int64_t>(c.xi * static_cast<double>(ticks) + 0.5);
    machine::AxisModel axis;
    axis.step_u = 0.01;
    axis.has_plant = true;
    axis.plant.motor = machine::MotorModel::rigid;
    axis.plant.base_mass_kg = 4.5;
    axis.plant.link_mass_kg = 2;
    axis.plant.link_stiffness_N_per_m = 2 * c.w * c.w;
    axis.plant.link_damping_Ns_per_m = 2 * c.zeta * c.w * 2;
    model.axis = {axis};
    Plant plant(model);

    const Law law{3500 / (16 * c.xi * (1 - c.xi)),
                  4 * static_cast<double>(corner) / static_cast<double>(ticks)};
    const auto check = [&](double x_m, double v_m_s) {
      const AxisState& s = plant.state()[0];
      if (x_m == 0) {
        CHECK(std::fabs(s.link_u * 1e-3) < 1e-10);
        CHECK(std::fabs(s.link_u_s * 1e-3) < 1e-8);
        return;
      }
      // relative to the motion's size: a state on its way through zero has no relative precision
      const double size_m = std::hypot(x_m, v_m_s / c.w);
      CHECK(std::fabs(s.link_u * 1e-3 - x_m) < 1e-8 * size_m);
      CHECK(std::fabs(s.link_u_s * 1e-3 - v_m_s) < 1e-8 * size_m * c.w);
    };
    const double tau_s = 4 / static_cast<double>(ticks);
    StepBatch batch;
    batch.axis.resize(1);
    for (std::int64_t k = 0; k < ticks; ++k) {
      const double t = static_cast<double>(k) * tau_s, end = static_cast<double>(k + 1) * tau_s;
      batch.tick = {k};
      batch.axis[0].command = {law.position(t), law.position(end), law.speed(t), law.speed(end)};
      REQUIRE(plant.advance(batch));
      if (k + 1 == corner) check(c.x_a, c.v_a);
      if (k + 1 == ticks - corner) check(c.x_b, c.v_b);
    }
    check(c.x_tf, c.v_tf);
    const AxisState& s = plant.state()[0];
    CHECK(s.base_u == 3500);
    const double wd = c.w * std::sqrt(1 - c.zeta * c.zeta);
    const double envelope_m = std::hypot(s.link_u, (s.link_u_s + c.zeta * c.w * s.link_u) / wd) * 1e-3;
    CHECK(std::fabs(envelope_m - c.envelope) < 1e-8 * c.envelope + 1e-10);
  }
}

TEST_CASE("a corner taken without a stop kicks the link by the jump of the base's speed") {
  // base at rest, then at 20 mm/s at once: the tool stays behind, x1' = -20 mm/s. Without damping
  // x1(t) = -20/w sin wt, the base moves on evenly; after 1 ms with w = 100: x1 = -0.2 sin 0.1 = -0.019966683329365628.
  machine::MachineModel model;
  machine::AxisModel axis;
  axis.step_u = 0.01;
  axis.has_plant = true;
  axis.plant.base_mass_kg = 3;
  axis.plant.link_mass_kg = 1;
  axis.plant.link_stiffness_N_per_m = 1e4;
  model.axis = {axis};
  Plant plant(model, {.energy = true});
  StepBatch batch;
  batch.axis.resize(1);
  batch.axis[0].command = {0, 0.02, 20, 20};
  REQUIRE(plant.advance(batch));
  CHECK(plant.state()[0].link_u == doctest::Approx(-0.019966683329365628).epsilon(1e-12));
  CHECK(plant.state()[0].link_u_s == doctest::Approx(-20 * 0.99500416527802577).epsilon(1e-12));
  // force that holds the base's speed: -k x1 = 0.19966683 N
  CHECK(plant.state()[0].motor_force_N == doctest::Approx(0.19966683329365628).epsilon(1e-12));
  // the kick costs m0 v^2/2 = 0.5 * 3 * 0.02^2 = 6e-4 J; the force then adds, by the integral of
  // k*0.2e-3*sin(100 t) times 0.02 m/s, 2 * 0.02/100 * (1 - cos 0.1) = 1.9983e-6 J
  const EnergyBalance e = plant.energy(0);
  CHECK(e.motor_work_J == doctest::Approx(6e-4 + 4e-4 * (1 - 0.99500416527802577)).epsilon(1e-10));
  CHECK(e.motor_work_J == doctest::Approx(e.kinetic_J + e.spring_J + e.dissipated_J).epsilon(1e-12));
}
