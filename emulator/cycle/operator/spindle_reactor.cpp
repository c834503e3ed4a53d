#include "emulator/cycle/operator/spindle_reactor.h"

#include <algorithm>
#include <cmath>

namespace kadr::cycle {
namespace {

/// Nearest number of control ticks, at least one.
ControlTicks whole_ticks(double time_ms, double tau_s) {
  return {std::max<std::int64_t>(1, static_cast<std::int64_t>(std::floor(time_ms / (1000 * tau_s) + 0.5)))};
}

/// Whether a step is due: the first after `wait`, then one `every` so many ticks.
bool is_due(ControlTicks since, ControlTicks wait, ControlTicks every) {
  return since >= wait && (since - wait).value % every.value == 0;
}

}  // namespace

SpindleReactor::SpindleReactor(const machine::SpindleReaction& rule, double tau_s)
    : high_wait_(whole_ticks(rule.high_ms, tau_s)),
      down_every_(whole_ticks(rule.down_ms, tau_s)),
      low_wait_(whole_ticks(rule.low_ms, tau_s)),
      up_every_(whole_ticks(rule.up_ms, tau_s)),
      high_load_(rule.high_load_pct / 100),
      low_load_(rule.low_load_pct / 100),
      down_pct_(rule.down_pct),
      up_pct_(rule.up_pct),
      least_pct_(rule.least_pct) {}

double SpindleReactor::advance(double load) {
  high_ = load > high_load_ ? high_ + ControlTicks{1} : ControlTicks{};
  low_ = load < low_load_ ? low_ + ControlTicks{1} : ControlTicks{};
  if (is_due(high_, high_wait_, down_every_))
    override_pct_ = std::max(std::min(least_pct_, override_pct_), override_pct_ - down_pct_);
  if (is_due(low_, low_wait_, up_every_)) override_pct_ = std::min(100.0, override_pct_ + up_pct_);
  return override_pct_ / 100;
}

bool SpindleReactor::unsettled(double load) const {
  return (load > high_load_ && override_pct_ > least_pct_) || (load < low_load_ && override_pct_ < 100);
}

}  // namespace kadr::cycle
