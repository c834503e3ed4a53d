#include "emulator/log_tools/diff/frame_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace kadr::log_tools {
namespace {

std::optional<double> number_of(const log::FieldValue& value) {
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* number = std::get_if<std::int64_t>(&value)) return static_cast<double>(*number);
  return std::nullopt;
}

std::optional<double> difference_of(const log::FieldValue& a, const log::FieldValue& b) {
  if (const auto* x = std::get_if<std::int64_t>(&a), *y = std::get_if<std::int64_t>(&b); x && y)
    return static_cast<double>(*y - *x);
  const auto p = number_of(a), q = number_of(b);
  if (!p || !q) return std::nullopt;
  return *q - *p;
}

/// An item in one line, for a log that has it where the other has none.
struct Describe {
  std::string operator()(const log::EventRecord& e) const {
    return e.text.empty() ? e.kind.text() : fmt::format("{}: {}", e.kind.text(), e.text);
  }
  std::string operator()(const log::BlockRecord& b) const {
    return fmt::format("block {}: {}", b.block, b.text);
  }
  std::string operator()(const log::LogDiagnostic& d) const {
    return fmt::format("{}: {}", d.code, d.message);
  }
};

/// The items of one type, in the log's order.
template <class Record>
std::vector<const Record*> records(const LogFrame& frame) {
  std::vector<const Record*> list;
  for (const LogItem& item : frame.items)
    if (const auto* record = std::get_if<Record>(&item)) list.push_back(record);
  return list;
}

TickAt tick_at(const LogFrame& frame) { return {*frame.ticks, frame.tick_index}; }
AxisAt axis_at(const LogFrame& frame, std::size_t axis) { return {*frame.ticks, axis, frame.tick_index}; }

}  // namespace

std::vector<AxisPair> common_axes(const log::LogHeader& a, const log::LogHeader& b) {
  std::vector<AxisPair> pairs;
  for (std::size_t i = 0; i < a.axis.size(); ++i)
    for (std::size_t j = 0; j < b.axis.size(); ++j)
      if (a.axis[i].name == b.axis[j].name) {
        pairs.push_back({i, j, a.axis[i].name, a.axis[i].unit, a.axis[i].unit == "deg"});
        break;
      }
  return pairs;
}

/// Destination of differences: the mask always, the list on request.
struct FrameCompare::Sink {
  std::vector<FieldDifference>* list;
  const FrameCompare& compare;
  ChannelMask mask = 0;

  bool wants(DiffChannel channel) {
    mask |= mask_of(channel);
    return list != nullptr;
  }
  template <class Record>
  void add(DiffChannel channel, const LogField<Record>& field, const AxisPair* axis, const log::FieldValue& a,
           const log::FieldValue& b, Ticks tick) {
    if (!wants(channel)) return;
    list->push_back({channel, std::string(field.name), axis ? axis->name : "",
                     unit_text(field.unit, compare.path_unit_, axis ? axis->unit : ""), value_text(field, a),
                     value_text(field, b), field.word ? std::nullopt : difference_of(a, b), tick});
  }
  void add(DiffChannel channel, std::string field, const std::string& axis, std::string a, std::string b,
           Ticks tick, std::optional<double> difference = std::nullopt, const char* unit = "") {
    if (wants(channel))
      list->push_back({channel, std::move(field), axis, unit, std::move(a), std::move(b), difference, tick});
  }

  /// The fields of a record that is in both logs.
  template <class Record>
  void fields(DiffChannel channel, std::span<const LogField<Record>> table, const Record& a, const Record& b,
              const AxisPair* axis, Ticks tick) {
    bool tolerated = false;
    if constexpr (std::is_same_v<Record, log::EventRecord>) tolerated = compare.within_tolerance(a, b);
    for (const auto& field : table) {
      if (!compare.compares(channel, field.name)) continue;
      if (tolerated && (field.name == "value" || field.name == "text")) continue;
      const log::FieldValue x = field.get(a), y = field.get(b);
      if (!same_value(x, y)) add(channel, field, axis, x, y, tick);
    }
  }
  /// Records of one kind in their order; one log may have more of them.
  template <class Record>
  void items(DiffChannel channel, std::span<const LogField<Record>> table, const char* what,
             const LogFrame& a, const LogFrame& b) {
    const bool all_ignored = std::none_of(
        table.begin(), table.end(), [&](const auto& field) { return compare.compares(channel, field.name); });
    if (all_ignored) return;
    const auto of_a = records<Record>(a), of_b = records<Record>(b);
    for (std::size_t i = 0; i < std::max(of_a.size(), of_b.size()); ++i) {
      const Record* x = i < of_a.size() ? of_a[i] : nullptr;
      const Record* y = i < of_b.size() ? of_b[i] : nullptr;
      const Ticks tick = sane_tick(x && y ? std::min(x->tick, y->tick) : (x ? x : y)->tick);
      if (x && y)
        fields(channel, table, *x, *y, nullptr, tick);
      else
        add(channel, what, "", x ? Describe{}(*x) : "-", y ? Describe{}(*y) : "-", tick);
    }
  }
};

FrameCompare::FrameCompare(const log::LogHeader& a, const log::LogHeader& b, const DiffOptions& options)
    : options_(options),
      axes_(common_axes(a, b)),
      control_tick_ticks_(a.control_tick_ticks),
      path_unit_(path_unit(a)),
      ticks_(a.logs_ticks && b.logs_ticks),
      steps_(a.logs_steps && b.logs_steps),
      count_ignored_(options.ignores(DiffChannel::steps, "pulses")),
      offset_ignored_(options.ignores(DiffChannel::steps, "offset_ticks")),
      sign_ignored_(options.ignores(DiffChannel::steps, "sign")) {
  for (const auto& field : tick_fields())
    tick_ignored_.push_back(options.ignores(DiffChannel::command, field.name));
  for (const auto& field : axis_fields())
    axis_ignored_.push_back(options.ignores(
        field.key == log::ToleranceKey::none ? DiffChannel::command : DiffChannel::load, field.name));
  for (const AxisPair& axis : axes_)
    for (const auto& field : axis_fields())
      peaks_.push_back(
          {std::string(field.name), axis.name, unit_text(field.unit, path_unit_, axis.unit), 0, 0});
}

ChannelMask FrameCompare::compare(const LogFrame& a, const LogFrame& b, std::vector<FieldDifference>* list) {
  Sink sink{list, *this};
  if (!a.items.empty() || !b.items.empty()) compare_items(a, b, sink);
  if (ticks_) compare_commands(a, b, sink);
  if (steps_) compare_steps(a, b, sink);
  if (ticks_) compare_load(a, b, sink);
  return sink.mask;
}

bool FrameCompare::within_tolerance(const log::EventRecord& a, const log::EventRecord& b) const {
  if (a.kind != log::EventKind::residual || b.kind != log::EventKind::residual) return false;
  if (options_.ignores(DiffChannel::load, "link_u")) return true;
  for (const AxisPair& axis : axes_)
    if (a.axis == static_cast<int>(axis.a) && b.axis == static_cast<int>(axis.b)) {
      const auto tolerance = options_.tolerance.of(log::ToleranceKey::link, axis.rotary);
      return tolerance && std::fabs(b.value - a.value) <= *tolerance;
    }
  return false;
}

void FrameCompare::compare_items(const LogFrame& a, const LogFrame& b, Sink& sink) const {
  sink.items(DiffChannel::event, event_fields(), "event", a, b);
  sink.items(DiffChannel::block, block_fields(), "block", a, b);
  sink.items(DiffChannel::diagnostic, diagnostic_fields(), "diagnostic", a, b);
}

void FrameCompare::compare_commands(const LogFrame& a, const LogFrame& b, Sink& sink) const {
  const Ticks end{(a.control_tick + 1) * control_tick_ticks_};
  const bool all_ignored = std::all_of(tick_ignored_.begin(), tick_ignored_.end(), [](bool i) { return i; });
  if (!a.ticks || !b.ticks) {
    if ((a.ticks || b.ticks) && !all_ignored)
      sink.add(DiffChannel::command, "control tick", "", a.ticks ? "there" : "-", b.ticks ? "there" : "-",
               end);
    return;
  }
  const TickAt x = tick_at(a), y = tick_at(b);
  const auto table = tick_fields();
  for (std::size_t f = 0; f < table.size(); ++f) {
    if (tick_ignored_[f]) continue;
    const log::FieldValue p = table[f].get(x), q = table[f].get(y);
    if (is_absent(p) || is_absent(q)) continue;
    if (!same_value(p, q)) sink.add(DiffChannel::command, table[f], nullptr, p, q, end);
  }
  const auto of_axis = axis_fields();
  for (const AxisPair& axis : axes_)
    for (std::size_t f = 0; f < of_axis.size(); ++f) {
      if (of_axis[f].key != log::ToleranceKey::none || axis_ignored_[f]) continue;
      const log::FieldValue p = of_axis[f].get(axis_at(a, axis.a)), q = of_axis[f].get(axis_at(b, axis.b));
      if (is_absent(p) || is_absent(q)) continue;
      if (!same_value(p, q)) sink.add(DiffChannel::command, of_axis[f], &axis, p, q, end);
    }
}

void FrameCompare::compare_steps(const LogFrame& a, const LogFrame& b, Sink& sink) const {
  const StepBatch *x = a.batch(), *y = b.batch();
  const Ticks begin{a.control_tick * control_tick_ticks_};
  if (!x || !y) {
    if ((x || y) && !(count_ignored_ && offset_ignored_ && sign_ignored_))
      sink.add(DiffChannel::steps, "control tick", "", x ? "there" : "-", y ? "there" : "-", begin);
    return;
  }
  for (const AxisPair& axis : axes_) {
    const AxisPulses &p = x->axis[axis.a], &q = y->axis[axis.b];
    const bool same_signs = p.count() == 0 || (p.first_sign == q.first_sign && p.reversals == q.reversals);
    if (p.offset_ticks != q.offset_ticks || !same_signs) compare_pulses(p, q, axis, begin, sink);
  }
}

/// The first pulse that differs, and the counts.
void FrameCompare::compare_pulses(const AxisPulses& a, const AxisPulses& b, const AxisPair& axis, Ticks begin,
                                  Sink& sink) const {
  const auto signs = [](const AxisPulses& pulses) {
    std::vector<int> list;
    pulses.for_each([&](std::uint16_t, int sign) { list.push_back(sign); });
    return list;
  };
  const std::vector<int> p = signs(a), q = signs(b);
  const std::size_t both = std::min(p.size(), q.size());
  std::size_t i = 0;
  while (i < both && (offset_ignored_ || a.offset_ticks[i] == b.offset_ticks[i]) &&
         (sign_ignored_ || p[i] == q[i]))
    ++i;
  const auto pulse = [&](const char* field) { return fmt::format("pulse {} {}", i + 1, field); };
  if (i < both) {
    const int x = a.offset_ticks[i], y = b.offset_ticks[i];
    const Ticks tick = begin + Ticks{std::min(x, y)};
    if (x != y && !offset_ignored_)
      sink.add(DiffChannel::steps, pulse("offset_ticks"), axis.name, std::to_string(x), std::to_string(y),
               tick, y - x);
    if (p[i] != q[i] && !sign_ignored_)
      sink.add(DiffChannel::steps, pulse("sign"), axis.name, p[i] > 0 ? "+1" : "-1", q[i] > 0 ? "+1" : "-1",
               tick);
  }
  if (p.size() != q.size() && !count_ignored_) {
    const auto& longer = p.size() > q.size() ? a.offset_ticks : b.offset_ticks;
    sink.add(DiffChannel::steps, "pulses", axis.name, std::to_string(p.size()), std::to_string(q.size()),
             begin + Ticks{longer[both]}, static_cast<double>(q.size()) - static_cast<double>(p.size()));
  }
}

void FrameCompare::compare_load(const LogFrame& a, const LogFrame& b, Sink& sink) {
  if (!a.ticks || !b.ticks || !a.ticks->has_plant || !b.ticks->has_plant) return;
  const Ticks end{(a.control_tick + 1) * control_tick_ticks_};
  const auto table = axis_fields();
  for (std::size_t n = 0; n < axes_.size(); ++n)
    for (std::size_t f = 0; f < table.size(); ++f) {
      const auto& field = table[f];
      if (field.key == log::ToleranceKey::none || axis_ignored_[f]) continue;
      const AxisPair& axis = axes_[n];
      const log::FieldValue p = field.get(axis_at(a, axis.a)), q = field.get(axis_at(b, axis.b));
      if (is_absent(p) || is_absent(q) || same_value(p, q)) continue;
      const double size = std::fabs(difference_of(p, q).value_or(0));
      LoadPeak& peak = peaks_[n * table.size() + f];
      if (!(size <= peak.difference)) {
        peak.difference = size;
        peak.control_tick = a.control_tick;
      }
      const auto tolerance = options_.tolerance.of(field.key, axis.rotary);
      if (!tolerance || !(size <= *tolerance)) sink.add(DiffChannel::load, field, &axis, p, q, end);
    }
}

ChannelMask FrameCompare::compare_summaries(const log::LogSummary& a, const log::LogSummary& b,
                                            std::vector<FieldDifference>& list) const {
  Sink sink{&list, *this};
  const Ticks tick = std::min(a.run.ticks, b.run.ticks);
  sink.fields(DiffChannel::summary, summary_fields(), a, b, nullptr, tick);
  for (const AxisPair& axis : axes_)
    if (axis.a < a.run.axis.size() && axis.b < b.run.axis.size())
      sink.fields(DiffChannel::summary, axis_summary_fields(), AxisSummaryAt{a, axis.a},
                  AxisSummaryAt{b, axis.b}, &axis, tick);
  return sink.mask;
}

std::vector<FieldDifference> FrameCompare::same_fields(const LogFrame& a, const LogFrame& b) const {
  std::vector<FieldDifference> list;
  if (!a.ticks || !b.ticks) return list;
  for (const auto& field : tick_fields()) {
    const log::FieldValue p = field.get(tick_at(a)), q = field.get(tick_at(b));
    if (!same_value(p, q)) continue;
    const std::string text = value_text(field, p);
    list.push_back({DiffChannel::command, std::string(field.name), "", unit_text(field.unit, path_unit_, ""),
                    text, text, std::nullopt, Ticks{(a.control_tick + 1) * control_tick_ticks_}});
  }
  return list;
}

std::vector<LoadPeak> FrameCompare::load_peaks() const {
  std::vector<LoadPeak> list;
  for (const LoadPeak& peak : peaks_)
    if (peak.difference != 0) list.push_back(peak);
  return list;
}

std::string FrameCompare::value(const LogFrame& frame, bool first, const std::string& field,
                                const std::string& axis) const {
  if (!frame.ticks) return "-";
  for (const auto& f : tick_fields())
    if (axis.empty() && f.name == field) return value_text(f, f.get(tick_at(frame)));
  for (const AxisPair& pair : axes_)
    for (const auto& f : axis_fields())
      if (pair.name == axis && f.name == field &&
          (f.key == log::ToleranceKey::none || frame.ticks->has_plant))
        return value_text(f, f.get(axis_at(frame, first ? pair.a : pair.b)));
  return "-";
}

}  // namespace kadr::log_tools
