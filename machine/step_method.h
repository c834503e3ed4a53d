#pragma once
#include <cstdint>

#include "machine/base/vocabulary.h"

namespace kadr::machine {

/// The pulses of a segment and their moments: half-crossings when they occur, or a method of paper 002 at one
/// clock slot per step, for study. `newton` and all after it belong to the laboratory (`kadr teach`): no
/// machine runs them.
enum class StepMethod : std::uint8_t {
  crossing,
  classic,
  half_step,
  diagonal,
  extra_points,
  octant_midpoint,
  dda,
  dda_preloaded,
  dda_sequential,
  dda_simultaneous,
  progression,
  chords,
  ptp,
  newton,
  printed_difference,
  printed_half_step,
  magnitudes,
};

inline constexpr Vocabulary<StepMethod, 17> kStepMethods{{
    {StepMethod::crossing, "crossing", "the axis whose next half-crossing comes first"},
    {StepMethod::classic, "classic", "sign of F at the node"},
    {StepMethod::half_step, "half_step", "sign of F half a step ahead in both coordinates"},
    {StepMethod::diagonal, "diagonal", "V_i: the longer axis always, the other one with it where V >= 0"},
    {StepMethod::extra_points, "extra_points", "signs of F at two points beside the neighbours"},
    {StepMethod::octant_midpoint, "octant_midpoint", "sign of F at one point, by octants"},
    {StepMethod::dda, "dda", "overflow of registers that begin at 0"},
    {StepMethod::dda_preloaded, "dda_preloaded", "overflow of registers that begin half full"},
    {StepMethod::dda_sequential, "dda_sequential", "circle by two registers, one after the other"},
    {StepMethod::dda_simultaneous, "dda_simultaneous", "circle by two registers at once: a spiral"},
    {StepMethod::progression, "progression", "sums of constant or evenly growing increments"},
    {StepMethod::chords, "chords", "chords within a tolerance, each by diagonal"},
    {StepMethod::ptp, "ptp", "point to point: each axis at its own rate"},
    {StepMethod::newton, "newton", "Newton's forward differences in fixed point"},
    {StepMethod::printed_difference, "printed_difference", "as printed: sign of F(i,j+1) - F(i+1,j)"},
    {StepMethod::printed_half_step, "printed_half_step", "as printed: eq. 7 in place of F'"},
    {StepMethod::magnitudes, "magnitudes", "sign of |F(i,j+1)| - |F(i+1,j)|: the nearer neighbour"},
}};
static_assert(kStepMethods.complete());

/// Those that a machine can run (key interpolator.method).
inline constexpr auto kMachineMethods = kStepMethods.up_to<StepMethod::ptp>();

}  // namespace kadr::machine
