#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/log/log_messages.h"
#include "machine/step_hash.h"

namespace kadr::log {

struct LogEventView;

/// What is wrong with a log: a sentence with measured and allowed value; nothing: it is sound.
using Breach = std::optional<std::string>;

/// Proves a log as a sequence: what one message says about another is checked here (docs/log_format.md,
/// section 6), so that readers may rely on it. A message by itself is proved by its decoder.
class LogProof {
 public:
  /// What the header says about itself: axes, units, the program's hash.
  static Breach of_header(const LogHeader& header);

  /// @param header  a sound one; it must outlive the proof
  explicit LogProof(const LogHeader& header);
  /// The next message, in the log's order, KADR_RUN first.
  /// @param hashes_deny  KADR_SUMMARY holds other hashes: what it says about the rest is not asked
  Breach add(const LogEventView& event, const LogMessage& message, bool hashes_deny = false);
  /// Of the pulses so far.
  std::uint64_t steps_hash() const { return steps_hash_.digest(); }

 private:
  struct Stretch {
    std::int64_t first = 0, end = 0;  // control ticks
  };
  struct AxisSums {
    std::int64_t pulses = 0, net_steps = 0, last_node = 0;
  };

  Breach stamp(const LogEventView& event, const LogMessage& message);
  Breach stretch(ControlTicks first, std::size_t ticks) const;
  Breach columns(const TickBlock& ticks);
  Breach numbers(const TickBlock& ticks);
  Breach viewers(const TickBlock& ticks);
  Breach viewer(const TickBlock& ticks, const FeedSample& sample) const;
  Breach viewer(const TickBlock& ticks, const AxisSample& sample) const;
  Breach totals(const LogSummary& summary) const;
  Breach axis_totals(const LogSummary& summary) const;

  Breach check(const LogHeader&) { return {}; }
  Breach check(const BlockRecord& block);
  Breach check(const BlockEndRecord& end);
  Breach check(const TickBlock& ticks);
  Breach check(const StepBlock& steps);
  Breach check(const FeedSample& sample);
  Breach check(const AxisSample& sample);
  Breach check(const EventRecord& event);
  Breach check(const LogDiagnostic&) { return {}; }
  Breach check(const LogSummary& summary);
  Breach check(const UnknownMessage&) { return {}; }

  const LogHeader& header_;
  bool hashes_deny_ = false;
  std::int64_t last_us_ = 0;                 // the latest stamp
  std::int64_t control_ticks_ = 0;           // in KADR_TICKS, or in KADR_STEPS if those are off
  std::int64_t next_tick_ = 0;               // the first control tick that exact data may begin with
  std::optional<Stretch> steps_due_;         // of the KADR_TICKS whose KADR_STEPS follows
  std::optional<bool> plant_, override_;     // columns of the first KADR_TICKS
  double path_u_ = 0;                        // at the end of the exact data
  std::uint32_t last_block_ = 0;             // begun last
  std::int64_t blocks_ = 0;                  // begun
  std::int64_t approaches_ = 0;              // of these, which are none of the program's
  std::optional<std::uint32_t> last_ended_;  // block
  std::optional<std::int64_t> last_viewed_;  // control tick of the KADR_FEED read last
  int last_axis_ = -1;                       // of the viewer messages of that control tick
  std::vector<FeedSample> feeds_;            // of the control ticks whose exact data follow
  std::vector<AxisSample> axes_;
  std::vector<AxisSums> sums_;  // [axes]
  std::int64_t alarms_ = 0;
  StepHash steps_hash_;
};

}  // namespace kadr::log
