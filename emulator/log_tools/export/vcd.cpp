#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/log_tools/export/export.h"
#include "machine/tick_motion.h"

namespace kadr::log_tools {
namespace {

constexpr std::int64_t kSlotsPerTick = 10;  ///< a pulse is high for one of them

/// A base tick in units of the dump's timescale.
struct Timescale {
  std::string name;      ///< "10 ns"
  std::int64_t units_s;  ///< in a second
  bool exact = true;     ///< a base tick is a whole number of units

  std::int64_t units(Ticks tick, std::int64_t base_hz) const {
    // tick = whole seconds and a rest, so that nothing overflows
    const std::int64_t whole = tick.value / base_hz, rest = tick.value % base_hz;
    return whole * units_s + rest * (units_s / base_hz) + rest * (units_s % base_hz) / base_hz;
  }
};

/// The coarsest timescale in which a base tick is a whole number of at least ten units; else nearest below.
Timescale timescale_for(std::int64_t base_hz) {
  static constexpr const char* kNames[] = {"100 ns", "10 ns", "1 ns", "100 ps", "10 ps", "1 ps"};
  std::int64_t units_s = 10'000'000;
  for (const char* name : kNames) {
    if (units_s % base_hz == 0 && units_s / base_hz >= kSlotsPerTick) return {name, units_s, true};
    units_s *= 10;
  }
  return {"1 ps", 1'000'000'000'000, false};
}

/// Short names of wires: "!", "\"", ... as the format has them.
std::string identifier(std::size_t number) {
  std::string out;
  for (++number; number > 0; number = (number - 1) / 94)
    out += static_cast<char>('!' + static_cast<char>((number - 1) % 94));
  return out;
}

struct Change {
  std::int64_t time;
  std::size_t order;
  std::string text;
};

class Dump {
 public:
  Dump(LogSamples& log, const Sink& sink)
      : log_(log), sink_(sink), header_(log.header()), scale_(timescale_for(header_.base_hz)) {}

  void write() {
    head();
    for (Sample sample; log_.next(sample);) {
      pulses(sample);
      states(sample);
      flush();
    }
    if (last_ >= 0) sink_(fmt::format("#{}\n", last_ + 1));
  }

 private:
  enum Wire : std::size_t { moving, accelerating, braking, hold, alarm, kWires };

  std::size_t step_wire(std::size_t axis) const { return kWires + 2 * axis; }
  std::size_t dir_wire(std::size_t axis) const { return kWires + 2 * axis + 1; }
  std::size_t signal_wire(std::size_t k) const { return kWires + 2 * header_.axis.size() + k; }

  void head() {
    std::string out =
        fmt::format("$version kadr {} $end\n$comment {} on {} $end\n", plain(header_.kadr_version),
                    plain(header_.program_name), plain(header_.machine_name));
    if (!scale_.exact) out += "$comment base ticks are rounded down to 1 ps $end\n";
    out += fmt::format("$timescale {} $end\n$scope module kadr $end\n", scale_.name);
    const auto wire = [&](std::size_t number, const std::string& name) {
      out += fmt::format("$var wire 1 {} {} $end\n", identifier(number), name);
    };
    static constexpr const char* kNames[kWires] = {"moving", "accelerating", "braking", "hold", "alarm"};
    for (std::size_t w = 0; w < kWires; ++w) wire(w, kNames[w]);
    for (std::size_t a = 0; a < header_.axis.size(); ++a) {
      if (!header_.logs_steps) break;
      const std::string axis = word(header_.axis[a].name);
      wire(step_wire(a), axis + "_step");
      wire(dir_wire(a), axis + "_dir");
    }
    for (std::size_t k = 0; k < log_.chosen().size(); ++k)
      out +=
          fmt::format("$var real 64 {} {} $end\n", identifier(signal_wire(k)), word(log_.chosen()[k].name));
    out += "$upscope $end\n$enddefinitions $end\n";
    sink_(out);
    level_.assign(kWires + 2 * header_.axis.size(), -1);
    shown_.assign(log_.chosen().size(), std::numeric_limits<double>::quiet_NaN());
  }

  /// Names within comments: `$end` in them would end the comment.
  static std::string plain(std::string text) {
    std::replace(text.begin(), text.end(), '$', '_');
    for (char& c : text)
      if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '_';
    return text;
  }

  /// A name of a variable: white space would end it.
  static std::string word(const std::string& text) {
    std::string out = plain(text);
    std::replace(out.begin(), out.end(), ' ', '_');
    return out;
  }

  void add(std::int64_t time, std::string text) {
    changes_.push_back({time, changes_.size(), std::move(text)});
  }

  void set(std::int64_t time, std::size_t wire, bool on) {
    if (level_[wire] == int{on}) return;
    level_[wire] = on;
    add(time, fmt::format("{}{}\n", on ? '1' : '0', identifier(wire)));
  }

  void pulses(const Sample& sample) {
    const Ticks begin{sample.control_tick * header_.control_tick_ticks};
    if (!begun_) {
      for (std::size_t w = 0; w < level_.size(); ++w)
        if (header_.logs_steps || w < kWires) set(scale_.units(begin, header_.base_hz), w, false);
      begun_ = true;
    }
    const StepBatch* batch = sample.frame->batch();
    if (batch == nullptr) return;
    const std::int64_t slot = std::max<std::int64_t>(1, scale_.units_s / header_.base_hz / kSlotsPerTick);
    for (std::size_t a = 0; a < batch->axis.size() && a < header_.axis.size(); ++a) {
      std::int64_t last = -1, in_tick = 0;
      batch->axis[a].for_each([&](std::uint16_t offset, int sign) {
        in_tick = offset == last ? in_tick + 1 : 0;
        last = offset;
        const std::int64_t at = scale_.units(begin + Ticks{offset}, header_.base_hz) + 2 * slot * in_tick;
        set(at, dir_wire(a), sign > 0);
        set(at, step_wire(a), true);
        set(at + slot, step_wire(a), false);
      });
    }
  }

  void states(const Sample& sample) {
    const std::int64_t at = scale_.units(sample.end, header_.base_hz);
    const log::TickBlock& ticks = *sample.frame->ticks;
    const std::size_t i = sample.frame->tick_index;
    set(at, moving, ticks.feed_u_s[i] > 0);
    set(at, accelerating, ticks.accel_u_s2[i] > 0);
    set(at, braking, ticks.accel_u_s2[i] < 0);
    set(at, hold, ticks.limited_by[i] == static_cast<std::int8_t>(LimitedBy::hold));
    for (const LogItem& item : sample.frame->items)
      if (const auto* event = std::get_if<log::EventRecord>(&item);
          event != nullptr && event->kind == log::EventKind::alarm)
        set(at, alarm, true);
    for (std::size_t k = 0; k < sample.value.size(); ++k) {
      const double value = sample.value[k];
      if (value == shown_[k] || !std::isfinite(value)) continue;
      shown_[k] = value;
      add(at, fmt::format("r{} {}\n", value, identifier(signal_wire(k))));
    }
  }

  /// Changes up to the end of the control tick, in order of time.
  void flush() {
    std::sort(changes_.begin(), changes_.end(), [](const Change& a, const Change& b) {
      return a.time != b.time ? a.time < b.time : a.order < b.order;
    });
    text_.clear();
    for (const Change& change : changes_) {
      if (change.time != last_) fmt::format_to(std::back_inserter(text_), "#{}\n", change.time);
      last_ = change.time;
      text_ += change.text;
    }
    changes_.clear();
    sink_(text_);
  }

  LogSamples& log_;
  const Sink& sink_;
  const log::LogHeader& header_;
  Timescale scale_;
  std::vector<int> level_;     // of every wire; -1: not written yet
  std::vector<double> shown_;  // of every real
  std::vector<Change> changes_;
  std::string text_;
  std::int64_t last_ = -1;
  bool begun_ = false;
};

}  // namespace

void write_vcd(LogSamples& log, const Sink& sink) { Dump(log, sink).write(); }

}  // namespace kadr::log_tools
