#include "emulator/studies/teach/sweep.h"

#include <bit>

namespace kadr::studies {
namespace {

namespace lattice = interpolator::lattice;

using lattice::Curve;
using lattice::Method;

constexpr std::int64_t kMostSlots = 3000;

/// Whole numbers from SplitMix64, the same everywhere. Each is drawn in a statement or list of its own: the
/// order of a call's arguments is the compiler's.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed) {}
  /// least .. most
  std::int64_t next(std::int64_t least, std::int64_t most) {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    z ^= z >> 31;
    return least + static_cast<std::int64_t>(z % static_cast<std::uint64_t>(most - least + 1));
  }
  std::int64_t other_than_0(std::int64_t most) {
    const std::int64_t v = next(1, 2 * most);
    return v <= most ? v : most - v;
  }

 private:
  std::uint64_t state_;
};

lattice::LineCurve line(Numbers& numbers, int axes) {
  lattice::LineCurve out{axes, {}};
  for (std::size_t k = 0; k < static_cast<std::size_t>(axes); ++k) out.delta[k] = numbers.next(-40, 40);
  if (out.delta == lattice::Point{}) out.delta[0] = 1;
  return out;
}

/// A quarter, half, three quarters or whole of a circle from a node of it, or from one near an axis.
lattice::ArcCurve arc(Numbers& numbers) {
  lattice::PlaneNode begin{numbers.other_than_0(40), numbers.next(-30, 30)};
  const auto turn = numbers.next(0, 1) == 0 ? lattice::Turn::ccw : lattice::Turn::cw;
  lattice::PlaneNode end = begin;
  for (std::int64_t quarters = numbers.next(0, 3); quarters > 0; --quarters) end = {-end.y, end.x};
  return {begin, end, turn};
}

Curve bezier(Numbers& numbers, int axes, int degree) {
  lattice::BezierCurve out{axes, degree, {}};
  for (std::size_t i = 1; i <= static_cast<std::size_t>(degree); ++i)
    for (std::size_t k = 0; k < static_cast<std::size_t>(axes); ++k)
      out.control[i][k] = numbers.next(-40, 40);
  if (out.control[1] == lattice::Point{}) out.control[1][0] = 1;
  return out;
}

Curve curve(Numbers& numbers) {
  switch (numbers.next(0, 7)) {
    case 0:
    case 1:
      return line(numbers, 2);
    case 2:
      return line(numbers, static_cast<int>(numbers.next(3, 5)));
    case 3:
    case 4:
      return arc(numbers);
    case 5: {
      const auto turn = numbers.next(0, 1) == 0 ? lattice::Turn::ccw : lattice::Turn::cw;
      const std::int64_t a = numbers.next(2, 30), b = numbers.next(2, 30);
      return lattice::ellipse(a, b, turn);
    }
    case 6:
      return lattice::ParabolaCurve{numbers.other_than_0(30), numbers.next(-30, -1), numbers.next(0, 30)};
    default: {
      const auto axes = static_cast<int>(numbers.next(2, 3)), degree = static_cast<int>(numbers.next(2, 3));
      return bezier(numbers, axes, degree);
    }
  }
}

}  // namespace

SweepCase sweep_case(std::uint32_t n) {
  Numbers numbers(n);
  SweepCase out{curve(numbers), Method::half_step};
  std::vector<Method> known;
  for (const lattice::MethodEntry& m : lattice::methods())
    if (lattice::knows(m.method, out.curve)) known.push_back(m.method);
  out.method = known[static_cast<std::size_t>(numbers.next(0, static_cast<std::int64_t>(known.size()) - 1))];
  return out;
}

std::uint64_t sweep_hash(std::uint32_t first, std::uint32_t count, std::uint64_t hash) {
  const auto add = [&](std::uint64_t v) {
    for (int i = 0; i < 8; ++i) hash = (hash ^ ((v >> (8 * i)) & 255)) * 1099511628211ULL;
  };
  for (std::uint32_t n = first; n < first + count; ++n) {
    const SweepCase c = sweep_case(n);
    const lattice::Made made = lattice::make_stepper(c.curve, c.method);
    add(static_cast<std::uint64_t>(made.refusal));
    if (!made.stepper) continue;
    const lattice::Trace trace = lattice::run(*made.stepper, c.curve, kMostSlots);
    add(trace.hash);
    for (const lattice::Slot& slot : trace.slots) {
      add(static_cast<std::uint64_t>(slot.value));
      add(static_cast<std::uint64_t>(slot.tested));
      add(static_cast<std::uint64_t>(slot.tested_y));
      add(std::bit_cast<std::uint64_t>(slot.parameter));
    }
  }
  return hash;
}

}  // namespace kadr::studies
