#include "plant/linear_response.h"

#include "plant/propagator.h"

namespace kadr::plant {

namespace {

// theta^q / q! as a chain of integrators after the axis: u = chain[0], chain[i]' = chain[i + 1]
std::array<Vector4, 6> monomial_responses(const AxisEquations& eq) {
  const Matrix4 a = eq.system();
  Matrix<10> chained;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) chained.at[i][j] = a.at[i][j];
  }
  chained.at[kBaseSpeed][4] = eq.a;
  chained.at[kLinkSpeed][4] = -eq.a;
  for (std::size_t i = 4; i < 9; ++i) chained.at[i][i + 1] = 1;
  const Matrix<10> over_tick = exponential(chained);
  std::array<Vector4, 6> response;
  double factorial = 1;
  for (std::size_t q = 0; q < 6; ++q) {
    if (q > 0) factorial *= static_cast<double>(q);
    for (std::size_t i = 0; i < 4; ++i) response[q][i] = over_tick.at[i][4 + q] * factorial;
  }
  return response;
}

bool same(const AxisEquations& a, const AxisEquations& b) {
  return a.a == b.a && a.B == b.B && a.p == b.p && a.q == b.q && a.p1 == b.p1 && a.q1 == b.q1 &&
         a.step_m == b.step_m && a.control_ticks == b.control_ticks;
}

}  // namespace

LinearResponse::LinearResponse(const AxisEquations& eq) : monomial(monomial_responses(eq)) {
  const Ticks control_tick{static_cast<std::int64_t>(eq.control_ticks)};
  const Propagator propagator(eq.system(), control_tick);
  whole_tick = exponential(eq.system());
  row.reserve(static_cast<std::size_t>(control_tick.value));
  for (Ticks offset; offset < control_tick; ++offset) {
    // a step leaves the base one step behind; what remains of that lag is missing from the whole step
    const Vector4 lag = propagator.apply(control_tick - offset, {1, 0, 0, 0});
    row.push_back(
        {{(1 - lag[0]) * eq.step_m, -lag[1] * eq.step_m, -lag[2] * eq.step_m, -lag[3] * eq.step_m}});
  }
}

Vector4 LinearResponse::pulses(const AxisPulses& pulses) const {
  const std::size_t count = pulses.count();
  const std::uint16_t* offset = pulses.offset_ticks.data();
  if (!pulses.reversals.empty()) {
    Vector4 sum{};
    pulses.for_each([&](std::uint16_t at, int sign) {
      for (std::size_t i = 0; i < 4; ++i) sum[i] += sign * row[at].at[i];
    });
    return sum;
  }
  // two running sums, so that one addition need not wait for the other
  double even[4] = {0, 0, 0, 0}, odd[4] = {0, 0, 0, 0};
  std::size_t n = 0;
  for (; n + 1 < count; n += 2) {
    const double* first = row[offset[n]].at;
    const double* second = row[offset[n + 1]].at;
    for (std::size_t i = 0; i < 4; ++i) {
      even[i] += first[i];
      odd[i] += second[i];
    }
  }
  if (n < count) {
    for (std::size_t i = 0; i < 4; ++i) even[i] += row[offset[n]].at[i];
  }
  Vector4 sum;
  for (std::size_t i = 0; i < 4; ++i) sum[i] = pulses.first_sign * (even[i] + odd[i]);
  return sum;
}

std::shared_ptr<const LinearResponse> LinearResponse::shared(
    const AxisEquations& equations,
    std::vector<std::pair<AxisEquations, std::shared_ptr<const LinearResponse>>>& known) {
  for (const auto& [of, response] : known) {
    if (same(of, equations)) return response;
  }
  known.emplace_back(equations, std::make_shared<const LinearResponse>(equations));
  return known.back().second;
}

}  // namespace kadr::plant
