#pragma once
#include "machine/base/count.h"
#include "machine/machine.h"

namespace kadr::cycle {

/// The feed override that the spindle's load requests, control tick by control tick (machine::SpindleReaction):
/// down step by step while the load is high, up again while it is low.
class SpindleReactor {
 public:
  SpindleReactor(const machine::SpindleReaction& rule, double tau_s);
  /// One control tick under a load (ratio). @return the override in force in it, ratio
  double advance(double load);
  /// The override can still change under this load.
  bool unsettled(double load) const;

 private:
  ControlTicks high_wait_, down_every_, low_wait_, up_every_;
  double high_load_, low_load_, down_pct_, up_pct_, least_pct_;
  ControlTicks high_, low_;  // how long the load has been so
  double override_pct_ = 100;
};

}  // namespace kadr::cycle
