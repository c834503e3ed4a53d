#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/log/channel.h"
#include "emulator/log/records.h"

namespace kadr::log {

struct LogAxis {
  std::string name;  ///< "X"
  std::string unit;  ///< "mm" or "deg"
  double step_u = 0;
  double home_u = 0;
  bool has_plant = false;
};

/// KADR_RUN
struct LogHeader {
  Ticks tick;
  std::int32_t log_format = 0;
  std::string kadr_version;
  std::int64_t base_hz = 0;
  std::int64_t control_tick_ticks = 0;  ///< tau
  std::string program_name;
  std::string program_text;  ///< empty if the program was longer than 1 MiB
  std::int64_t program_bytes = 0;
  std::uint64_t program_hash = 0;
  std::string machine_toml, scenario_toml, settings_toml;
  std::uint64_t inputs_hash = 0;
  std::string machine_name;
  bool logs_ticks = false, logs_steps = false;
  std::int32_t block_ticks = 0;
  std::int32_t viewer_every_ticks = 0;
  std::vector<LogAxis> axis;
  std::vector<std::string> files;  ///< a ReadFile each, as text
  double seconds(Ticks t) const { return static_cast<double>(t.value) / static_cast<double>(base_hz); }
};

/// "program 32 0123456789abcdef part.ngc": role, bytes, hash and name.
std::string file_text(const ReadFile& file);
/// Reads what file_text() wrote; nothing if it is something else.
std::optional<ReadFile> parse_file_text(std::string_view text);

/// The header of a run that begins.
LogHeader log_header(const RunHeader& run);

const char* check_message(LogHeader& header, std::string_view channel, const LogHeader&);

template <std::same_as<LogHeader> R>
struct Channel<R> {
  static constexpr ChannelTitle info{"KADR_RUN", "run_t",
                                     "event 0: program, machine, scenario, settings, clock, axes"};
  static constexpr std::size_t first_fields = 24;
  static constexpr std::array fields{
      field::i64<&R::tick>("tick", "0"),
      field::i32<&R::log_format>("log_format", "2"),
      field::text<&R::kadr_version>("kadr_version", ""),
      field::i64<&R::base_hz>("base_hz", "base ticks per second, a multiple of 1 000 000"),
      field::i32<&R::control_tick_ticks>("control_tick_ticks", "tau, base ticks in a control tick"),
      field::text<&R::program_name>("program_name", "file name without folders"),
      field::text<&R::program_text>("program_text",
                                    "empty if longer than 1 MiB: then only its length and hash are kept"),
      field::i64<&R::program_bytes>("program_bytes", "length of the program"),
      field::i64<&R::program_hash>("program_hash", "XXH3, 64 bit"),
      field::text<&R::machine_toml>("machine_toml", "as read"),
      field::text<&R::scenario_toml>("scenario_toml", "as read, empty if none"),
      field::text<&R::settings_toml>("settings_toml", "every value in force"),
      field::i64<&R::inputs_hash>("inputs_hash", "of program, machine, scenario and settings"),
      field::text<&R::machine_name>("machine_name", ""),
      field::flag<&R::logs_ticks>("logs_ticks", "KADR_TICKS is written"),
      field::flag<&R::logs_steps>("logs_steps", "KADR_STEPS is written"),
      field::i32<&R::block_ticks>("block_ticks", "control ticks in a full KADR_TICKS or KADR_STEPS message"),
      field::i32<&R::viewer_every_ticks>("viewer_every_ticks",
                                         "control ticks between two KADR_FEED, 0: none"),
      field::count<R, field::length<&R::axis>>("n_axes", CountRule::axes),
      field::text<&R::axis, &LogAxis::name>("axis_names", "\"X\", \"Y\", \"Z\", \"A\"").by("n_axes"),
      field::text<&R::axis, &LogAxis::unit>("axis_units", "\"mm\" or \"deg\"").by("n_axes"),
      field::real<&R::axis, &LogAxis::step_u>("step_u", FieldUnit::axis, "one motor step").by("n_axes"),
      field::real<&R::axis, &LogAxis::home_u>("home_u", FieldUnit::axis, "machine position at program start")
          .by("n_axes"),
      field::flag<&R::axis, &LogAxis::has_plant>("has_plant", "two masses are modelled").by("n_axes"),
      field::count<R, field::length<&R::files>>("n_files", CountRule::any, "files that were read"),
      field::text<&R::files>("files", "\"program 32 0123456789abcdef part.ngc\": role, bytes, XXH3, name")
          .by("n_files"),
  };
};

}  // namespace kadr::log
