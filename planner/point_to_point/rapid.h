#pragma once
#include <cstdint>
#include <string_view>

#include "planner/point_to_point/synthesis.h"

namespace kadr::planner {

/// How a rapid gets from rest to rest.
enum class RapidShape : std::uint8_t {
  scurve,     ///< the fastest T law averaged over one period
  t_zero,     ///< the fastest T law that is silent by its own ramps
  zv,         ///< the fastest T law, shaped by two impulses
  zvd,        ///< shaped by three
  automatic,  ///< one of the above, by the rule of rapid_law()
};

struct RapidTask {
  PointTask motion;
  DrivenMode driven;  ///< what the law is tuned to
  RapidShape shape = RapidShape::automatic;
  double omega_uncertainty = 0.01;  ///< relative: how well the frequency is known
};

/// A law for a rapid, and why this one.
struct RapidLaw {
  PointLaw law;
  RapidShape shape = RapidShape::t_zero;  ///< never automatic
  std::string_view reason;                ///< of an automatic choice; else empty
  double loss_s = 0;                      ///< over the fastest law within the limits
  double amplitude_u = 0;                 ///< residual vibration if the frequency is right
};

/// The fastest law of a shape within the limits, silent at the mode (a T law and an S-curve without damping
/// only). Neither speed nor acceleration exceeds its limit by more than 1e-12 of it. Automatic:
///   T law   without damping, if it loses less than half a period to the fastest law there is and the
///           frequency is known to 1/(100 n), n the periods in the ramp (its zeros are 1/n apart)
///   ZV      if the frequency is known to 1 % (leaves (pi/2 uncertainty) of the vibration, 1.6 %)
///   ZVD     else (leaves the square of that)
/// Takes microseconds and owns no memory.
/// @return the law, or what is wrong with the task
PointResult<RapidLaw> rapid_law(const RapidTask& task);

std::string_view rapid_shape_name(RapidShape shape);

}  // namespace kadr::planner
