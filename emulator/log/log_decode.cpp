#include "emulator/log/log_decode.h"

#include <fmt/format.h>

#include <algorithm>

#include "emulator/log/pulse_code.h"
#include "emulator/log/wire.h"

namespace kadr::emulator {
namespace {

constexpr std::int32_t kMaxAxes = 64;
constexpr std::int64_t kMaxTick = std::int64_t{1} << 62;

template <class T>
using Decoded = tl::expected<T, std::string>;

tl::unexpected<std::string> invalid(const char* why) { return tl::unexpected<std::string>(why); }

/// What every decoder ends with: all fields were there, and nothing else.
template <class T>
Decoded<T> finished(const WireReader& in, T value) {
  if (!in.ok()) return invalid("its fields do not fit its length");
  if (!in.at_end()) return invalid("bytes are left over after its fields");
  return value;
}

std::uint32_t u32(std::int32_t v) { return static_cast<std::uint32_t>(v); }

std::int32_t axis_count(WireReader& in, const LogHeader& header) {
  const auto axes = static_cast<std::int32_t>(header.axis.size());
  return in.count(axes, axes);
}

/// Base tick and number of a block's first control tick, which must agree.
void begin_of_block(WireReader& in, const LogHeader& header, Ticks& begin, ControlTicks& first) {
  begin = Ticks{in.i64()};
  first = ControlTicks{in.i64()};
  if (first.value < 0 || first.value > kMaxTick / header.control_tick_ticks ||
      begin.value != first.value * header.control_tick_ticks)
    in.fail();
}

Decoded<BlockRecord> decode_block(WireReader in) {
  BlockRecord r;
  r.tick = Ticks{in.i64()};
  in.f64();  // t_s
  r.block = u32(in.i32());
  r.span.line = u32(in.i32());
  r.span.column = u32(in.i32());
  r.text = in.string();
  r.motion = in.string();
  r.length_u = in.f64();
  r.programmed_u_s = in.f64();
  r.planned_peak_u_s = in.f64();
  r.planned_end_u_s = in.f64();
  r.planned_s = in.f64();
  r.limited_by = in.string();
  r.entry_u_s = in.f64();
  r.planned_entry_u_s = in.f64();
  r.deferred_ticks = ControlTicks{in.i32()};
  return finished(in, std::move(r));
}

Decoded<BlockEndRecord> decode_block_end(WireReader in) {
  BlockEndRecord r;
  r.tick = Ticks{in.i64()};
  in.f64();  // t_s
  r.block = u32(in.i32());
  r.line = u32(in.i32());
  const std::int32_t axes = in.count(0, kMaxAxes);
  r.peak_link_u = in.f64s(axes);
  r.peak_following_u = in.f64s(axes);
  const std::int32_t energy_axes = in.count(0, kMaxAxes);
  r.positive_J = in.f64s(energy_axes);
  r.recuperated_J = in.f64s(energy_axes);
  return finished(in, std::move(r));
}

void decode_steps_columns(WireReader& in, TickBlock& b, std::int32_t ticks,
                          const std::vector<std::int64_t>& base) {
  for (std::size_t a = 0; a < b.axis.size(); ++a) {
    const auto deltas = in.i32s(ticks);
    if (!in.ok()) return;
    if (base[a] > kMaxTick || base[a] < -kMaxTick) in.fail();
    if (!in.ok()) return;
    b.axis[a].steps.reserve(deltas.size());
    for (const std::int32_t delta : deltas) b.axis[a].steps.push_back(base[a] + delta);
  }
}

Decoded<TickBlock> decode_ticks(WireReader in, const LogHeader& header) {
  TickBlock b;
  begin_of_block(in, header, b.begin, b.first);
  const std::int32_t ticks = in.count(1, kMaxBlockTicks);
  const std::int32_t axes = axis_count(in, header);
  const std::int32_t plant_axes = in.count(0, axes);
  if (plant_axes != 0 && plant_axes != axes) in.fail();
  const std::int32_t override_ticks = in.count(0, ticks);
  if (override_ticks != 0 && override_ticks != ticks) in.fail();
  for (auto* column : {&b.feed_u_s, &b.accel_u_s2, &b.path_u, &b.override_used}) *column = in.f64s(ticks);
  b.limited_by = in.i8s(ticks);
  b.limiting_axis = in.i8s(ticks);
  for (const std::int32_t block : in.i32s(ticks)) b.block.push_back(u32(block));
  const auto base = in.i64s(axes);
  if (!in.ok()) return invalid("its fields do not fit its length");
  b.axis.resize(static_cast<std::size_t>(axes));
  b.has_plant = plant_axes > 0;
  decode_steps_columns(in, b, ticks, base);
  for (AxisTicks& axis : b.axis) axis.command_u = in.f64s(ticks);
  for (auto column : {&AxisTicks::base_u, &AxisTicks::base_u_s, &AxisTicks::link_u, &AxisTicks::link_u_s,
                      &AxisTicks::motor_force_N})
    for (std::int32_t a = 0; a < plant_axes; ++a)
      b.axis[static_cast<std::size_t>(a)].*column = in.f64s(ticks);
  b.override_requested = in.f64s(override_ticks);
  b.limiter = in.f64s(override_ticks);
  b.override_note = in.i8s(override_ticks);
  if (override_ticks == 0) {  // nobody asked for anything
    b.override_requested = b.override_used;
    b.limiter.assign(b.size(), 1.0);
    b.override_note.assign(b.size(), 0);
  }
  return finished(in, std::move(b));
}

Decoded<StepBlock> decode_steps(WireReader in, const LogHeader& header) {
  StepBlock b;
  begin_of_block(in, header, b.begin, b.first);
  PulseCounts counts;
  counts.ticks = in.count(1, kMaxBlockTicks);
  counts.control_tick_ticks = static_cast<std::int32_t>(header.control_tick_ticks);
  const std::int32_t axes = axis_count(in, header);
  const auto pulses = in.i32s(axes);
  const auto reversals = in.i32s(axes);
  const auto bytes = in.i32s(axes);
  std::int64_t sum = 0;
  for (const std::int32_t n : bytes) {
    if (n < 0) in.fail();
    sum += n;
  }
  if (in.i32() != sum) in.fail();
  if (!in.ok()) return invalid("its fields do not fit its length");

  b.batches.resize(static_cast<std::size_t>(counts.ticks));
  for (std::size_t i = 0; i < b.batches.size(); ++i) {
    b.batches[i].tick = ControlTicks{b.first.value + static_cast<std::int64_t>(i)};
    b.batches[i].axis.resize(header.axis.size());
  }
  for (std::size_t a = 0; a < header.axis.size(); ++a) {
    counts.pulses = pulses[a];
    counts.reversals = reversals[a];
    const auto code = in.bytes(bytes[a]);
    if (!in.ok()) return invalid("its fields do not fit its length");
    if (auto decoded = decode_pulses(code, counts, b.batches, a); !decoded)
      return tl::unexpected(fmt::format("axis {}: {}", header.axis[a].name, decoded.error()));
  }
  return finished(in, std::move(b));
}

Decoded<FeedSample> decode_feed(WireReader in) {
  FeedSample s;
  s.tick = Ticks{in.i64()};
  s.t_s = in.f64();
  s.block = u32(in.i32());
  s.path_u = in.f64();
  s.commanded_u_s = in.f64();
  s.acceleration_u_s2 = in.f64();
  s.jerk_u_s3 = in.f64();
  s.override_used_pct = in.f64();
  s.phase = in.i8();
  s.limited_by = in.i8();
  return finished(in, s);
}

Decoded<AxisSample> decode_axis(WireReader in, std::string_view channel, const LogHeader& header) {
  AxisSample s;
  const std::string_view name = channel.substr(kAxisChannelPrefix.size());
  for (std::size_t a = 0; a < header.axis.size(); ++a)
    if (header.axis[a].name == name) s.axis = static_cast<int>(a);
  if (s.axis < 0) return invalid("the header has no such axis");
  s.tick = Ticks{in.i64()};
  s.t_s = in.f64();
  s.steps = in.i64();
  for (double* field :
       {&s.ideal, &s.commanded, &s.motor, &s.load, &s.load_rate, &s.load_minus_ideal_um, &s.motor_force_N})
    *field = in.f64();
  return finished(in, s);
}

Decoded<EventRecord> decode_event(WireReader in) {
  EventRecord r;
  r.tick = Ticks{in.i64()};
  in.f64();  // t_s
  r.block = u32(in.i32());
  r.span.line = u32(in.i32());
  r.span.column = u32(in.i32());
  r.kind = StoredWord<kEventKinds>::read(in.string());
  const std::string code = in.string();
  if (!code.empty()) r.code = parse_code(code).value_or(Code{});
  r.axis = in.i32();
  r.value = in.f64();
  r.limit = in.f64();
  r.text = in.string();
  return finished(in, std::move(r));
}

Decoded<LogDiagnostic> decode_diag(WireReader in) {
  LogDiagnostic d;
  d.tick = Ticks{in.i64()};
  const std::int8_t severity = in.i8();
  if (severity < 1 || severity > 3) in.fail();
  d.severity = static_cast<Severity>(std::clamp<int>(severity - 1, 0, 2));
  d.code = in.string();
  d.span.line = u32(in.i32());
  d.span.column = u32(in.i32());
  d.span.length = u32(in.i32());
  d.message = in.string();
  d.label = in.string();
  d.notes = in.strings(in.i32());
  d.help = in.string();
  return finished(in, std::move(d));
}

void decode_shares(WireReader& in, std::vector<LimitShare>& shares) {
  const std::int32_t count = in.i32();
  const auto names = in.strings(count);
  const auto times_s = in.f64s(count);
  for (std::size_t i = 0; i < std::min(names.size(), times_s.size()); ++i)
    shares.push_back({names[i], times_s[i]});
}

/// The summary's columns, one value an axis, in the order of summary_t.
void decode_axis_summaries(WireReader& in, std::vector<AxisSummary>& axis) {
  const auto integers = [&](auto&& put) {
    for (AxisSummary& a : axis) put(a, in.i64());
  };
  const auto reals = [&](double AxisSummary::*field) {
    for (AxisSummary& a : axis) a.*field = in.f64();
  };
  integers([](AxisSummary& a, std::int64_t v) { a.pulses = v; });
  integers([](AxisSummary& a, std::int64_t v) { a.net_steps = Steps{v}; });
  integers([](AxisSummary& a, std::int64_t v) { a.end_steps = Steps{v}; });
  reals(&AxisSummary::end_u);
  reals(&AxisSummary::min_u);
  reals(&AxisSummary::max_u);
  reals(&AxisSummary::peak_feed_u_s);
  integers([](AxisSummary& a, std::int64_t v) { a.peak_feed_tick = Ticks{v}; });
  reals(&AxisSummary::peak_accel_u_s2);
  reals(&AxisSummary::peak_jerk_u_s3);
  reals(&AxisSummary::peak_vibration_u);
  integers([](AxisSummary& a, std::int64_t v) { a.peak_vibration_tick = Ticks{v}; });
  for (AxisSummary& a : axis) a.peak_vibration_line = u32(in.i32());
  reals(&AxisSummary::rms_vibration_u);
  reals(&AxisSummary::residual_u);
  reals(&AxisSummary::peak_following_u);
  reals(&AxisSummary::rms_following_u);
  integers([](AxisSummary& a, std::int64_t v) { a.lost_steps = Steps{v}; });
  reals(&AxisSummary::positive_J);
  reals(&AxisSummary::recuperated_J);
}

Decoded<LogSummary> decode_summary(WireReader in) {
  LogSummary s;
  RunSummary& r = s.run;
  r.ticks = Ticks{in.i64()};
  in.f64();  // t_s
  r.outcome = StoredWord<kOutcomes>::read(in.string());
  r.control_ticks = ControlTicks{in.i64()};
  r.blocks = u32(in.i32());
  for (double* field : {&r.path_u, &r.mean_feed_u_s, &r.peak_feed_u_s, &r.motion_s, &r.dwell_s})
    *field = in.f64();
  r.pulses = in.i64();
  r.steps_hash = in.u64();
  s.content_hash = in.u64();
  r.path_error_u = in.f64();
  r.held_error_u = in.f64();
  r.axis.resize(static_cast<std::size_t>(in.count(0, kMaxAxes)));
  decode_axis_summaries(in, r.axis);
  decode_shares(in, r.limited_by);
  r.planned_s = in.f64();
  decode_shares(in, r.lost_by);
  r.alarms = static_cast<std::size_t>(in.i64());
  r.warnings = static_cast<std::size_t>(in.i64());
  r.exit_code = in.i32();
  return finished(in, std::move(s));
}

tl::unexpected<HeaderFault> header_fault(LogReadFault fault, const char* reason) {
  return tl::unexpected<HeaderFault>(HeaderFault{fault, reason});
}

void decode_header_axes(WireReader& in, LogHeader& h) {
  const std::int32_t axes = in.count(1, kMaxAxes);
  const auto names = in.strings(axes);
  const auto units = in.strings(axes);
  const auto step_u = in.f64s(axes);
  const auto home_u = in.f64s(axes);
  const auto has_plant = in.i8s(axes);
  if (!in.ok()) return;
  for (std::size_t a = 0; a < names.size(); ++a)
    h.axis.push_back({names[a], units[a], step_u[a], home_u[a], has_plant[a] != 0});
}

template <class T>
Decoded<LogMessage> as_message(Decoded<T> decoded) {
  if (!decoded) return tl::unexpected(decoded.error());
  return LogMessage(std::move(*decoded));
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c < 0x20 || c > 0x7e) c = '?';
  return out;
}

tl::expected<LogHeader, HeaderFault> decode_header(std::span<const std::uint8_t> data) {
  WireReader in(data);
  if (in.i64() != fingerprint(MessageKind::run))
    return header_fault(in.ok() ? LogReadFault::other_format : LogReadFault::cut_in_header,
                        "written by another version of kadr: its first message has other fields");
  LogHeader h;
  in.i64();  // tick
  h.log_format = in.i32();
  if (in.ok() && h.log_format != kLogFormat)
    return header_fault(LogReadFault::other_format, "written by another version of kadr: other log format");
  h.kadr_version = in.string();
  h.base_hz = in.i64();
  h.control_tick_ticks = in.i32();
  h.program_name = in.string();
  h.program_text = in.string();
  h.program_bytes = in.i64();
  h.program_hash = in.u64();
  h.machine_toml = in.string();
  h.scenario_toml = in.string();
  h.settings_toml = in.string();
  h.inputs_hash = in.u64();
  h.machine_name = in.string();
  h.logs_ticks = in.boolean();
  h.logs_steps = in.boolean();
  h.block_ticks = in.count(1, kMaxBlockTicks);
  h.viewer_every_ticks = in.i32();
  decode_header_axes(in, h);
  constexpr std::int64_t kMegahertz = 1'000'000, kMaxHz = 1'000'000'000'000, kMaxTau = 65536;
  const bool sane = h.base_hz >= kMegahertz && h.base_hz <= kMaxHz && h.base_hz % kMegahertz == 0 &&
                    h.control_tick_ticks >= 1 && h.control_tick_ticks <= kMaxTau && h.viewer_every_ticks >= 0;
  if (!in.ok() || !in.at_end() || !sane)
    return header_fault(LogReadFault::cut_in_header, "the log's first message is damaged");
  return h;
}

tl::expected<LogMessage, std::string> decode_message(const LogEventView& event, const LogHeader& header) {
  const MessageKind kind = message_kind(event.channel);
  if (kind == MessageKind::unknown) return LogMessage(UnknownMessage{});
  WireReader in(event.data);
  if (in.i64() != fingerprint(kind)) return invalid("its fingerprint is not that of its type");
  switch (kind) {
    case MessageKind::block:
      return as_message(decode_block(in));
    case MessageKind::block_end:
      return as_message(decode_block_end(in));
    case MessageKind::ticks:
      return as_message(decode_ticks(in, header));
    case MessageKind::steps:
      return as_message(decode_steps(in, header));
    case MessageKind::feed:
      return as_message(decode_feed(in));
    case MessageKind::axis:
      return as_message(decode_axis(in, event.channel, header));
    case MessageKind::event:
      return as_message(decode_event(in));
    case MessageKind::diag:
      return as_message(decode_diag(in));
    case MessageKind::summary:
      return as_message(decode_summary(in));
    case MessageKind::run:
    case MessageKind::unknown:
      break;
  }
  return invalid("a second header");
}

}  // namespace kadr::emulator
