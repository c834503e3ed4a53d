#include "emulator/interpolator/lattice/methods.h"

#include <algorithm>
#include <array>

namespace kadr::interpolator::lattice {
namespace {

using Options = MethodOptions;
using Followers = MethodEntry::Followers;

constexpr Columns kNone{"", "", ""};
constexpr Columns kHalfStepArc{"F", "N=F'-1/2"};
constexpr Columns kTwoPoints{"F", "4 M1", "4 M2"};
constexpr Columns kRegisters{"", "Jx", "Jy"};

MadeStepper half_step(const LineCurve& line, const Options& o) { return half_step_line(line, o.tie_to_y); }
MadeStepper half_step(const ArcCurve& arc, const Options&) { return rule_arc(arc, ArcRule::half_step); }
MadeStepper progression(const LineCurve& line, const Options& o) {
  return progression_line(line, o.fraction_bits);
}

/// A maker that needs no options.
template <auto kMake, class OneCurve>
MadeStepper plain(const OneCurve& curve, const Options&) {
  return kMake(curve);
}
template <ArcRule kRule>
MadeStepper by_rule(const ArcCurve& arc, const Options&) {
  return rule_arc(arc, kRule);
}
template <bool kPreloaded>
MadeStepper dda(const LineCurve& line, const Options&) {
  return dda_line(line, kPreloaded);
}
template <bool kSequential>
MadeStepper dda(const ArcCurve& arc, const Options&) {
  return dda_arc(arc, kSequential);
}

constexpr std::array<MethodEntry, machine::kStepMethods.size()> kMethods = {{
    {.method = Method::classic,
     .plane_line = plain<classic_line>,
     .line = plain<classic_line>,
     .arc = by_rule<ArcRule::classic>,
     .rule = CurveRule::classic,
     .line_columns = {"", "2i"},
     .tested_at = TestedAt::node,
     .on_machine = Followers{Method::classic, Method::classic}},
    {.method = Method::half_step,
     .plane_line = half_step,
     .line = half_step,
     .arc = half_step,
     .rule = CurveRule::half_step,
     .plane_line_columns = {"F", "G=2F'"},
     .line_columns = {"", "2i+1"},
     .arc_columns = kHalfStepArc,
     .curve_columns = {"F", "F'"},
     .scaled = true,
     .tested_at = TestedAt::half_step,
     .on_machine = Followers{Method::half_step, Method::half_step}},
    {.method = Method::diagonal,
     .plane_line = plain<diagonal_line>,
     .line = plain<diagonal_line>,
     .plane_line_columns = {"F", "V"},
     .line_columns = kNone,
     .tested_at = TestedAt::beside_longer,
     .on_machine = Followers{Method::diagonal, Method::octant_midpoint}},
    {.method = Method::extra_points,
     .plane_line = plain<extra_point_line>,
     .arc = by_rule<ArcRule::extra_points>,
     .rule = CurveRule::extra_points,
     .plane_line_columns = {"F", "2 M1", "2 M2"},
     .arc_columns = kTwoPoints,
     .curve_columns = {"F", " M1", " M2"},
     .scaled = true,
     .tested_at = TestedAt::beside_both,
     .on_machine = Followers{Method::extra_points, Method::extra_points}},
    {.method = Method::octant_midpoint,
     .arc = by_rule<ArcRule::octant_midpoint>,
     .arc_columns = kTwoPoints,
     .tested_at = TestedAt::beside_both,
     .on_machine = Followers{Method::diagonal, Method::octant_midpoint}},
    {.method = Method::dda,
     .plane_line = dda<false>,
     .line = dda<false>,
     .plane_line_columns = kRegisters,
     .line_columns = kRegisters,
     .on_machine = Followers{Method::dda, Method::dda_sequential}},
    {.method = Method::dda_preloaded,
     .plane_line = dda<true>,
     .line = dda<true>,
     .plane_line_columns = kRegisters,
     .line_columns = kRegisters,
     .on_machine = Followers{Method::dda_preloaded, Method::dda_sequential}},
    {.method = Method::dda_sequential,
     .arc = dda<true>,
     .arc_columns = kRegisters,
     .on_machine = Followers{Method::dda_preloaded, Method::dda_sequential}},
    {.method = Method::dda_simultaneous,
     .arc = dda<false>,
     .arc_columns = kRegisters,
     .on_machine = Followers{Method::dda_preloaded, Method::dda_simultaneous}},
    {.method = Method::progression,
     .plane_line = progression,
     .line = progression,
     .parabola = plain<progression_parabola>,
     .plane_line_columns = {"", "S"},
     .line_columns = {"", "S"},
     .curve_columns = {"F", "N=F'-1/4"},
     .tested_at = TestedAt::half_step,
     .on_machine = Followers{Method::progression, Method::progression}},
    {.method = Method::chords,
     .arc = [](const ArcCurve& arc, const Options& o) { return chord_arc(arc, o.chord_tolerance); },
     .arc_columns = kNone,
     .on_machine = Followers{Method::diagonal, Method::chords}},
    {.method = Method::newton,
     .parabola = [](const ParabolaCurve& p, const Options& o) { return newton_parabola(p, o.fraction_bits); },
     .graph = [](const ImplicitCurve& c, const Options& o) { return newton_explicit(c, o.fraction_bits); },
     .curve_columns = {"x", "d0", "d1"}},
    {.method = Method::crossing,
     .plane_line = half_step,
     .line = half_step,
     .arc = half_step,
     .bezier = plain<bezier_events>,
     .rule = CurveRule::half_step,
     .plane_line_columns = {"F", "G=2F'"},
     .line_columns = {"", "2i+1"},
     .arc_columns = kHalfStepArc,
     .curve_columns = {"F", "F'"},
     .scaled = true,
     .tested_at = TestedAt::half_step,
     .on_machine = Followers{Method::crossing, Method::crossing}},
    {.method = Method::ptp,
     .plane_line = plain<point_to_point>,
     .line = plain<point_to_point>,
     .plane_line_columns = kNone,
     .line_columns = kNone,
     .on_machine = Followers{Method::ptp, Method::ptp}},
    {.method = Method::printed_difference,
     .plane_line = plain<printed_difference_line>,
     .plane_line_columns = {"F", "D"},
     .tested_at = TestedAt::neighbours},
    {.method = Method::printed_half_step, .arc = plain<printed_half_step_arc>, .arc_columns = {"F", "D"}},
    {.method = Method::magnitudes,
     .plane_line = plain<magnitude_line>,
     .plane_line_columns = {"F", "D"},
     .tested_at = TestedAt::neighbours},
}};

/// Where each method is in the table.
constexpr auto kPlaceOf = [] {
  std::array<std::size_t, kMethods.size()> place{};
  place.fill(kMethods.size());
  for (std::size_t i = 0; i < kMethods.size(); ++i) place[static_cast<std::size_t>(kMethods[i].method)] = i;
  return place;
}();
static_assert(*std::max_element(kPlaceOf.begin(), kPlaceOf.end()) < kMethods.size(),
              "every method has its row, once");
static_assert(std::all_of(kMethods.begin(), kMethods.end(),
                          [](const MethodEntry& m) {
                            const auto last =
                                machine::kMachineMethods.words[machine::kMachineMethods.size() - 1];
                            return m.on_machine.has_value() == (m.method <= last.value);
                          }),
              "every method of a machine has its followers, and no other");

}  // namespace

std::span<const MethodEntry> methods() { return kMethods; }

std::optional<Method> method_of(std::string_view name) { return machine::kStepMethods.find(name); }

const MethodEntry& entry_of(Method method) { return kMethods[kPlaceOf[static_cast<std::size_t>(method)]]; }

}  // namespace kadr::interpolator::lattice
