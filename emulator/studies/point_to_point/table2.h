#pragma once
#include <array>
#include <string>
#include <vector>

/// Table 2 of paper 001, computed twice: as printed, with the settings that its digits reveal, and by physics.
namespace kadr::studies {

inline constexpr std::array<const char*, 7> kTable2Columns = {"xi", "Amax",   "Vmax",  "Pmax",
                                                              "E",  "V_load", "X_load"};
inline constexpr std::array<const char*, 7> kTable2Units = {"", "m/s2", "m/s", "W", "J", "m/s", "mm"};

struct Table2Row {
  double zeta = 0;
  std::string law;  ///< T1, T2, T3
  std::array<double, 7> printed{}, paper{}, physics{};

  /// Digits agree: the value, rounded to four decimals, is the printed one.
  bool agrees(std::size_t column) const;
};

/// The six laws of the table, as the paper computed them and by physics.
///   xi       T1, T3: least and largest energy among the zeros that the paper finds by forgetting tf: omega xi = 2 pi n
///            without damping, x1'(alpha = 1) = 0 at omega = 105 and zeta = 0.005 next to them with damping;
///            T2: 1/3 to 4 decimals
///   Pmax, E  K_g = 9.81, 10 001 nodes of alpha with the jumps at xi and 1 - xi decided in binary, trapezoids,
///            E four times too large
///   V, X     relative coordinate, signed maximum after tf; base sampled every 0.4 ms and joined by lines;
///            damped rows with omega = 105 and half the damping
/// Physics: omega = 100 pi/3 and the stated damping, K_g = g tf^2/xf, largest absolute values, exact.
std::vector<Table2Row> table2();

}  // namespace kadr::studies
