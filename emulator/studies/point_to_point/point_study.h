#pragma once
#include <string>
#include <vector>

#include "planner/point_to_point/point_to_point.h"

namespace kadr::studies {

/// The question to `kadr law`; the defaults are Table 1 of paper 001, with omega = 100 pi/3 rad/s, which it
/// rounds to 105. Lengths are metres, so that energies are joules.
struct PointQuestion {
  planner::PointTask task{3.5, 3.0, 1.0};
  double time_s = 4.0;        ///< of the motion, unless time_optimal
  bool time_optimal = false;  ///< as fast as the limits allow
  planner::Mode mode{104.71975511965978, 0.0};
  planner::Drive drive = planner::Drive::position;
  planner::Load load;
  bool printed_gravity = false;     ///< 9.81 taken for K_g, as the paper does (work.h)
  std::vector<double> xi;           ///< additional T laws to compare
  double omega_uncertainty = 0.01;  ///< for the advice
};

/// A law and its measurements.
struct PointRow {
  std::string name;
  planner::PointLaw law;
  double xi = 0;  ///< of a symmetric T law; 0: not one
  planner::Work work;
  double amplitude_m = 0;  ///< residual envelope at the end
  planner::ResidualPeaks peaks;
  double worst_m[3]{};  ///< largest envelope with omega off by up to kBands
};
inline constexpr double kBands[3] = {0.01, 0.05, 0.10};

struct PointStudy {
  planner::DrivenMode driven;  ///< vibration that the laws are tuned to
  planner::Load load;          ///< with the gravity that was used
  double shortest_s = 0;       ///< of any law within the limits
  std::vector<PointRow> rows;
  std::size_t chosen = 0;             ///< row that answers the paper's question: least energy or least time
  std::string answer;                 ///< the choice, and why
  std::string advice;                 ///< the law that a rapid would use
  std::vector<std::string> left_out;  ///< laws that do not fit into the time, with the shortest one they need
  std::size_t zeros = 0;              ///< silent xi at this time
};

/// Builds and measures every law of a question.
/// @return or the error: a quantity out of range, or the shortest possible time
planner::PointResult<PointStudy> study_point_laws(const PointQuestion& question);

}  // namespace kadr::studies
