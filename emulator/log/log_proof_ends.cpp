// What the first and the last message of a log say: the header of itself, the summary of all others.
#include <fmt/format.h>

#include <cmath>

#include "emulator/log/log_proof.h"
#include "machine/base/hash.h"

namespace kadr::log {

Breach LogProof::of_header(const LogHeader& h) {
  constexpr std::size_t kMostName = kMaxChannelBytes - Channel<AxisSample>::info.name.size();
  for (std::size_t a = 0; a < h.axis.size(); ++a) {
    const LogAxis& axis = h.axis[a];
    if (axis.name.empty() || axis.name.size() > kMostName)
      return fmt::format("the name of axis {} has {} bytes, 1 to {} are allowed", a, axis.name.size(),
                         kMostName);
    for (std::size_t before = 0; before < a; ++before)
      if (h.axis[before].name == axis.name) return fmt::format("axes {} and {} have one name", before, a);
    if (axis.unit != "mm" && axis.unit != "deg")
      return fmt::format("the unit of axis {} is neither mm nor deg", a);
    if (!std::isfinite(axis.step_u) || axis.step_u <= 0)
      return fmt::format("a step of axis {} is {} long, more than 0 is allowed", a, axis.step_u);
    if (!std::isfinite(axis.home_u)) return fmt::format("axis {} begins at {}", a, axis.home_u);
  }
  if (h.tick != Ticks{0}) return fmt::format("its tick is {}, a run begins at 0", h.tick.value);
  if (h.program_bytes < 0) return fmt::format("the program is {} bytes long", h.program_bytes);
  if (h.program_text.empty()) return {};
  const auto bytes = static_cast<std::int64_t>(h.program_text.size());
  // a zero byte of the program became U+FFFD in its text
  if (h.program_text.find("\xEF\xBF\xBD") != std::string::npos) return {};
  if (bytes != h.program_bytes)
    return fmt::format("its program_text has {} bytes, program_bytes is {}", bytes, h.program_bytes);
  Hash64 hash;
  hash.bytes(h.program_text.data(), h.program_text.size());
  if (hash.digest() != h.program_hash)
    return fmt::format("its program_text has the hash {}, program_hash is {}", hash_text(hash.digest()),
                       hash_text(h.program_hash));
  return {};
}

Breach LogProof::check(const LogSummary& s) {
  if (s.run.axis.size() != header_.axis.size())
    return fmt::format("n_axes is {}, in KADR_RUN it is {}", s.run.axis.size(), header_.axis.size());
  const auto alarms = static_cast<std::int64_t>(s.run.alarms);
  const auto warnings = static_cast<std::int64_t>(s.run.warnings);
  if (alarms < 0 || warnings < 0) return fmt::format("it counts {} alarms and {} warnings", alarms, warnings);
  return hashes_deny_ ? Breach{} : totals(s);
}

/// What the summary says of the messages before it.
Breach LogProof::totals(const LogSummary& s) const {
  const RunSummary& run = s.run;
  const bool exact = header_.logs_ticks || header_.logs_steps;
  // the control tick in which the plant failed is in no block
  const std::int64_t failed = run.outcome == Outcome::plant_error ? 1 : 0;
  const std::int64_t ticks = run.control_ticks.value;
  if (run.ticks.value / header_.control_tick_ticks != ticks ||
      run.ticks.value % header_.control_tick_ticks != 0)
    return fmt::format("control_ticks is {}, tick is {}", ticks, run.ticks.value);
  if (exact && (next_tick_ > ticks || next_tick_ < ticks - failed))
    return fmt::format("control_ticks is {}, the exact data end after {}", ticks, next_tick_);
  if (blocks_ - approaches_ > static_cast<std::int64_t>(run.blocks))
    return fmt::format("blocks is {}, KADR_BLOCK came {} times", run.blocks, blocks_ - approaches_);
  if (static_cast<std::int64_t>(run.alarms) != alarms_)
    return fmt::format("n_alarms is {}, KADR_EVENT has {}", run.alarms, alarms_);
  if (auto wrong = axis_totals(s)) return wrong;
  if (header_.logs_steps && failed == 0 && run.steps_hash != steps_hash())
    return fmt::format("steps_hash is {}, that of KADR_STEPS {}", hash_text(run.steps_hash),
                       hash_text(steps_hash()));
  return {};
}

Breach LogProof::axis_totals(const LogSummary& s) const {
  std::int64_t pulses = 0;
  for (std::size_t a = 0; a < sums_.size(); ++a) {
    const AxisSummary& axis = s.run.axis[a];
    const AxisSums& sums = sums_[a];
    pulses += sums.pulses;
    if (header_.logs_steps && axis.pulses != sums.pulses)
      return fmt::format("axis_pulses of axis {} is {}, KADR_STEPS has {}", a, axis.pulses, sums.pulses);
    if (header_.logs_steps && axis.net_steps.value != sums.net_steps)
      return fmt::format("net_steps of axis {} is {}, those of KADR_STEPS are {}", a, axis.net_steps.value,
                         sums.net_steps);
    if (control_ticks_ > 0 && header_.logs_ticks && axis.end_steps.value != sums.last_node)
      return fmt::format("end_steps of axis {} is {}, KADR_TICKS ends at {}", a, axis.end_steps.value,
                         sums.last_node);
  }
  if (header_.logs_steps && s.run.pulses != pulses)
    return fmt::format("pulses is {}, KADR_STEPS has {}", s.run.pulses, pulses);
  return {};
}

}  // namespace kadr::log
