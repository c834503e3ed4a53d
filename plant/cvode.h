#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace kadr::plant {

/// A numerical fault inside the plant; `axis` is the machine's axis or -1 for a group.
struct Fault {
  std::string flag;
  std::string detail;
  int axis = -1;
};
using Outcome = tl::expected<void, Fault>;

/// One system of ordinary differential equations under CVODE: Adams with fixed-point iteration (the plant is
/// not stiff at these tolerances), absolute tolerances only, vector operations of compile-time length.
class Cvode {
 public:
  /// dy/dt at (t, y); both arrays have one entry per tolerance.
  using Equations = void (*)(const void* self, double t, const double* y, double* dydt);

  /// @param tolerance  [n], absolute local error allowed per state; n is a multiple of 4 up to 36
  /// Any failure of SUNDIALS while making it is kept and reported by the first start().
  Cvode(const std::vector<double>& tolerance, Equations equations, const void* self);
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;
  ~Cvode();

  /// Longest internal step; 0 for none. How far CVODE may look past the end asked for.
  void set_max_step(double max_step);
  /// Multiplies all tolerances from the next start() on.
  void scale_tolerance(double factor);
  /// Forgets the past and begins at (t, y).
  Outcome start(double t, const double* y);
  /// Integrates to t_end and writes the state there. The inner steps may look past t_end.
  Outcome advance(double t_end, double* y);
  /// The same, but nothing beyond t_end is looked at: the equations may change there.
  Outcome advance_and_stop(double t_end, double* y);
  /// Inner steps since construction.
  std::int64_t steps() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kadr::plant
