#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/log_tools/diff/diff_options.h"
#include "emulator/log_tools/diff/log_frames.h"

namespace kadr::log_tools {

/// One value that is not the same in both logs.
struct FieldDifference {
  DiffChannel channel = DiffChannel::command;
  std::string field;                 ///< as in kadr.lcm; of a pulse "pulse 3 offset_ticks"
  std::string axis;                  ///< "X", or empty
  std::string unit;                  ///< or empty
  std::string a, b;                  ///< "-": this log has nothing there
  std::optional<double> difference;  ///< b - a of numbers, in `unit`
  Ticks tick;                        ///< base tick of the earlier one
  std::string name() const { return axis.empty() ? field : axis + " " + field; }
};

/// Largest difference of a plant state over both logs, within tolerance or not.
struct LoadPeak {
  std::string field, axis, unit;
  double difference = 0;  ///< |b - a|
  std::int64_t control_tick = 0;
};

/// Axes with the same name in both logs: index in each header.
struct AxisPair {
  std::size_t a = 0, b = 0;
  std::string name, unit;
  bool rotary = false;
};
std::vector<AxisPair> common_axes(const log::LogHeader& a, const log::LogHeader& b);

using ChannelMask = std::uint32_t;
constexpr ChannelMask mask_of(DiffChannel channel) { return 1u << static_cast<unsigned>(channel); }

/// Compares one control tick of two logs. Allocates nothing for ticks and pulses that are the same.
class FrameCompare {
 public:
  FrameCompare(const log::LogHeader& a, const log::LogHeader& b, const DiffOptions& options);

  const std::vector<AxisPair>& axes() const { return axes_; }
  /// @param list  if not null, the differences are appended in the order of DiffChannel
  /// @return the channels that differ
  ChannelMask compare(const LogFrame& a, const LogFrame& b, std::vector<FieldDifference>* list = nullptr);
  /// The fields of the path that two frames have in common; axes are left out.
  std::vector<FieldDifference> same_fields(const LogFrame& a, const LogFrame& b) const;
  ChannelMask compare_summaries(const log::LogSummary& a, const log::LogSummary& b,
                                std::vector<FieldDifference>& list) const;
  /// Plant states that differed by more than nothing, in the order of axes and fields.
  std::vector<LoadPeak> load_peaks() const;
  /// Value of a field of KADR_TICKS in a frame; "-" if it is not there.
  /// @param axis   name, or empty for a field of the path
  /// @param first  true: the frame is of log A
  std::string value(const LogFrame& frame, bool first, const std::string& field,
                    const std::string& axis) const;
  /// True if that field of that channel is compared.
  bool compares(DiffChannel channel, std::string_view field) const {
    return !options_.ignores(channel, field);
  }

  /// True if value and text of an event that is in both logs are not compared: the residual vibration of an
  /// axis, whose value follows from the plant, within the tolerance of `link`, or with `link` ignored.
  bool within_tolerance(const log::EventRecord& a, const log::EventRecord& b) const;

 private:
  struct Sink;
  void compare_items(const LogFrame& a, const LogFrame& b, Sink& sink) const;
  void compare_commands(const LogFrame& a, const LogFrame& b, Sink& sink) const;
  void compare_steps(const LogFrame& a, const LogFrame& b, Sink& sink) const;
  void compare_pulses(const AxisPulses& a, const AxisPulses& b, const AxisPair& axis, Ticks begin,
                      Sink& sink) const;
  void compare_load(const LogFrame& a, const LogFrame& b, Sink& sink);

  DiffOptions options_;
  std::vector<AxisPair> axes_;
  std::int64_t control_tick_ticks_;
  std::string path_unit_;
  bool ticks_ = false, steps_ = false;             // both logs have them
  std::vector<bool> tick_ignored_, axis_ignored_;  // [tick_fields], [axis_fields]
  bool count_ignored_, offset_ignored_, sign_ignored_;
  std::vector<LoadPeak> peaks_;  // [axes * axis_fields]
};

}  // namespace kadr::log_tools
