#pragma once
#include "scenarios/generator/wind.h"

/// The three windings behind wind(); parameters are in range already.
namespace kadr::scenarios {

/// Values by key, every parameter of the kind present.
class WindValues {
 public:
  WindValues(std::string_view kind, const WindSettings& settings);
  double operator[](std::string_view key) const;

 private:
  std::span<const WindParameter> parameters_;
  std::vector<double> values_;
};

/// Cylinder of radius R and length L, band b:
///   turns per layer = L/b,   B = +-atan(b/(2 pi R)),   one closing turn at each end while B turns over.
Winding hoop_winding(const WindValues& p);

/// Cylinder, fibre at alpha to the axis, eye at the radius rho:
///   dA/dX = tan(alpha)/R,  stroke = L tan(alpha)/R,  circuits n = ceil(2 pi R cos(alpha)/b),
///   lead = sqrt(rho^2 - R^2)/tan(alpha),  B = +-(90 deg - alpha),
///   turn d at each end with n (2 stroke + 2 d) = 2 pi k, gcd(k, n) = 1: the pattern closes after n circuits.
/// In the turn the mandrel keeps running evenly and the carriage follows a cubic that begins and ends at stroke speed.
Winding helix_winding(const WindValues& p);

/// Cylinder with two hemispheres, wound along geodesics: Clairaut, r sin(alpha) = r0.
///   on the cylinder sin(alpha) = r0/R;  on a dome, latitude l:  theta = asin(tan(l)/tan(l_max)), cos(l_max)
///   = r0/R, and a dome turns the mandrel by pi. Eye = contact + free fibre * tangent; Y = distance of the
///   eye from the axis, A = theta + atan2 of its angle, B = atan2(axial, hoop part of the tangent).
/// The rest to n (turn of a circuit) = 2 pi k, gcd(k, n) = 1, is spread evenly over the circuit: a small
/// departure from the geodesic that friction holds.
Winding dome_winding(const WindValues& p);

}  // namespace kadr::scenarios
