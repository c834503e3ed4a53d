#include <fmt/format.h>

#include "machine/base/parse_number.h"
#include "machine/file/data_sheet.h"

namespace kadr::machine {

namespace {

using Text = std::string_view;

/// Lines "key = value  # comment", the comments in one column.
class Lines {
 public:
  void text(Text line) { out_ += fmt::format("{}\n", line); }
  void key(Text key, Text value, Text comment) {
    out_ += fmt::format("{:<38} # {}\n", fmt::format("{} = {}", key, value), comment);
  }
  /// `matters`: a default that changes times.
  void value(Text name, const SheetValue& value, Text remark, bool matters = false) {
    const bool given = !value.given.empty();
    key(name, number_text(value.value),
        fmt::format("{}; {}",
                    given     ? "given: " + value.given
                    : matters ? "default, matters"
                              : "default",
                    remark));
  }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

void write_axis(Lines& out, const SheetAxis& axis) {
  const Text u = axis.unit();
  const auto key = [&](Text stem, Text suffix = "") { return fmt::format("{}_{}{}", stem, u, suffix); };
  out.text("");
  out.text("[[axis]]");
  out.key("name", fmt::format("\"{}\"", axis.letter),
          axis.turns() ? "rotary: every number in deg" : "linear: every number in mm");
  out.value(key("steps_per"), axis.steps_per_u, fmt::format("motor steps per {}, microsteps included", u));
  out.key(key("range"), fmt::format("[{}, {}]", number_text(axis.min_u), number_text(axis.max_u)),
          fmt::format("given: {}; {}, soft limits{}", axis.travel, u,
                      axis.zero_given ? "" : "; where zero lies: default, matters"));
  out.value(key("home"), axis.home_u, fmt::format("{}, where the axis stands when a program begins", u));
  out.value(key("max", "_s"), axis.max_u_s, fmt::format("{}/s, also the rapid rate", u));
  out.value(key("max_acceleration", "_s2"), axis.acceleration_u_s2, fmt::format("{}/s2", u), true);
  out.value(key("max_jerk", "_s3"), axis.jerk_u_s3, fmt::format("{}/s3; inf: acceleration jumps", u), true);
  out.value(key("junction_acceleration", "_s2"), {axis.junction_u_s2, {}},
            fmt::format("{0}/s2: the speed may jump by {1:.4g} {0}/s at a corner", u,
                        axis.junction_u_s2 * kSheetPeriod_s),
            true);
  out.text("  [axis.plant]");
  out.key("  model", "\"rigid\"",
          "default: follows its steps exactly; \"spring\" and \"stepper\" need masses");
}

}  // namespace

std::string render_data_sheet(const DataSheet& sheet, std::string_view name) {
  Lines out;
  out.text(fmt::format("# {}, from a data sheet:", name));
  out.text(fmt::format("#   kadr machine new {}{}", name, sheet.command));
  out.text("#");
  out.text(
      "# \"given\" marks what the data sheet said, \"default\" what was filled in. A default that matters "
      "changes");
  out.text("# times: put your machine's number there.");
  out.text("#");
  out.text(
      "# junction_acceleration decides the time of programs of short lines: at a corner an axis may change "
      "its");
  out.text(
      "# speed at once by this times the control period. The default passes a square corner as fast as grbl "
      "does");
  out.text("# with a junction deviation ($11) of 0.010 mm; lower is slower and smoother.");
  out.text("#");
  out.text(
      "# `kadr machine show FILE` prints every value in force; a copy of mill3 (`kadr machine new NAME`) "
      "explains all");
  out.text("# keys. A key that kadr does not know is an error.");
  out.key("format", "1", "edition of this file's format");
  out.key("name", fmt::format("\"{}\"", name), "the machine's name in reports");
  out.text("");
  out.text("[clock]");
  out.key("rate_hz", fmt::format("{:.0f}", kSheetClock_hz), "default: step pulses are stamped in its ticks");
  out.key("control_period_us", fmt::format("{:.0f}", kSheetPeriod_s * 1e6),
          "default: the feed is computed once per control period");
  out.text("");
  out.text("[planner]");
  out.value("tool_change_s", sheet.tool_change_s, "s, time that M6 takes", true);
  for (const SheetAxis& axis : sheet.axis) write_axis(out, axis);
  return out.take();
}

}  // namespace kadr::machine
