#pragma once
#include <array>
#include <vector>

#include "emulator/cycle/event_list.h"
#include "emulator/cycle/monitor/commanded_motion.h"

namespace kadr::cycle {

/// Watches the commanded motion for overruns of an axis's limits: position, speed, acceleration and jerk.
///
/// An overrun is one alarm when it begins and one "alarm end" with its worst value when it is over. In a tick
/// that contains a joint between segments, the corner's step of speed is allowed on top. An axis
/// at rest is not checked.
class LimitWatch {
 public:
  /// @param machine, commanded (of each tick before tick() is called), events  outlive this
  LimitWatch(const machine::MachineModel& machine, const CommandedMotion& commanded, EventList& events);
  /// @param end  of the tick
  void tick(Ticks end);
  /// Ends the overruns that are still open.
  void finish(Ticks end);
  std::size_t alarms() const { return alarms_; }

 private:
  enum class Limit : std::uint8_t { position, speed, acceleration, jerk };
  struct Overrun {
    bool open = false;
    double worst = 0, limit = 0;
  };
  struct Word;
  static const std::array<Word, 4> kWords;  // by Limit

  void watch_axis(std::size_t axis, Ticks end);
  void watch_position(std::size_t axis, double position_u, Ticks end);
  void watch(std::size_t axis, Limit kind, double value, double limit, Ticks end);
  void watch(std::size_t axis, Limit kind, bool over, double value, double limit, Ticks end);
  void tell(std::size_t axis, Limit kind, log::EventKind event, const Overrun& overrun, Ticks tick,
            std::string text);

  const machine::MachineModel& machine_;
  const CommandedMotion& commanded_;
  EventList& events_;
  std::vector<std::array<Overrun, 4>> overruns_;  // [axes] by Limit
  std::size_t alarms_ = 0;
};

}  // namespace kadr::cycle
