#include "gcode/interpret/predefined.h"

#include <array>

namespace kadr::gcode {
namespace {

constexpr double kVersionMajor = 2.9;  // of the dialect: LinuxCNC 2.9.0
constexpr double kVersionMinor = 0;

struct Context {
  const State& state;
  std::uint32_t line;
};
using Reader = double (*)(const Context&);

template <int Axis>
double position(const Context& c) {
  return c.state.program_position(Axis);
}
template <int Axis>
double machine_position(const Context& c) {
  return c.state.to_program_units(Axis, c.state.position[static_cast<std::size_t>(Axis)]);
}
double one_if(bool b) { return b ? 1 : 0; }
double always_zero(const Context&) { return 0; }

double motion_mode(const Context& c) { return motion_code(c.state); }
double plane(const Context& c) { return plane_code(c.state.plane); }
double work_system(const Context& c) {
  const int system = c.state.work_system;  // G54 .. G59 are 1 .. 6, G59.1 .. G59.3 are 7 .. 9
  return system <= 6 ? code::g54 + 10 * (system - 1) : code::g59 + system - 6;
}
double tool_length(const Context& c) {
  for (const double offset : c.state.tool_offset) {
    if (offset != 0) return 1;
  }
  return 0;
}
template <FeedMode Mode>
double feed_mode(const Context& c) {
  return one_if(c.state.feed_mode == Mode);
}

struct Entry {
  std::string_view name;
  Reader read;
};

const std::array kEntries = {
    Entry{"_x", position<0>},
    Entry{"_y", position<1>},
    Entry{"_z", position<2>},
    Entry{"_a", position<3>},
    Entry{"_b", position<4>},
    Entry{"_c", position<5>},
    Entry{"_u", position<6>},
    Entry{"_v", position<7>},
    Entry{"_w", position<8>},
    Entry{"_abs_x", machine_position<0>},
    Entry{"_abs_y", machine_position<1>},
    Entry{"_abs_z", machine_position<2>},
    Entry{"_abs_a", machine_position<3>},
    Entry{"_abs_b", machine_position<4>},
    Entry{"_abs_c", machine_position<5>},
    Entry{"_abs_u", machine_position<6>},
    Entry{"_abs_v", machine_position<7>},
    Entry{"_abs_w", machine_position<8>},
    Entry{"_line", [](const Context& c) -> double { return c.line; }},
    Entry{"_motion_mode", motion_mode},
    Entry{"_plane", plane},
    Entry{"_ccomp", [](const Context& c) -> double { return c.state.compensation_code; }},
    Entry{"_metric", [](const Context& c) { return one_if(!c.state.inches); }},
    Entry{"_imperial", [](const Context& c) { return one_if(c.state.inches); }},
    Entry{"_absolute", [](const Context& c) { return one_if(!c.state.incremental); }},
    Entry{"_incremental", [](const Context& c) { return one_if(c.state.incremental); }},
    Entry{"_inverse_time", feed_mode<FeedMode::inverse_time>},
    Entry{"_units_per_minute", feed_mode<FeedMode::units_per_minute>},
    Entry{"_units_per_rev", feed_mode<FeedMode::units_per_revolution>},
    Entry{"_coord_system", work_system},
    Entry{"_tool_offset", tool_length},
    Entry{"_retract_r_plane", [](const Context& c) { return one_if(!c.state.retract_to_start); }},
    Entry{"_retract_old_z", [](const Context& c) { return one_if(c.state.retract_to_start); }},
    Entry{"_spindle_rpm_mode", [](const Context& c) { return one_if(!c.state.constant_surface_speed); }},
    Entry{"_spindle_css_mode", [](const Context& c) { return one_if(c.state.constant_surface_speed); }},
    Entry{"_ijk_absolute_mode", [](const Context& c) { return one_if(c.state.arc_centers_absolute); }},
    Entry{"_lathe_diameter_mode", [](const Context& c) { return one_if(c.state.diameter_mode); }},
    Entry{"_lathe_radius_mode", [](const Context& c) { return one_if(!c.state.diameter_mode); }},
    Entry{"_spindle_on", [](const Context& c) { return one_if(c.state.turning != Turning::stopped); }},
    Entry{"_spindle_cw", [](const Context& c) { return one_if(c.state.turning == Turning::clockwise); }},
    Entry{"_mist", [](const Context& c) { return one_if(c.state.mist); }},
    Entry{"_flood", [](const Context& c) { return one_if(c.state.flood); }},
    Entry{"_speed_override", [](const Context& c) { return one_if(c.state.speed_override); }},
    Entry{"_feed_override", [](const Context& c) { return one_if(c.state.feed_override); }},
    Entry{"_adaptive_feed", always_zero},
    Entry{"_feed_hold", [](const Context& c) { return one_if(c.state.feed_hold); }},
    Entry{"_feed", [](const Context& c) { return c.state.feed_number; }},
    Entry{"_rpm", [](const Context& c) { return c.state.spindle_rpm; }},
    Entry{"_current_tool", [](const Context& c) -> double { return c.state.tool_in_spindle; }},
    Entry{"_current_pocket",
          [](const Context& c) -> double { return c.state.pocket_of(c.state.tool_in_spindle); }},
    Entry{"_selected_tool", [](const Context& c) -> double { return c.state.tool_selected; }},
    Entry{"_selected_pocket",
          [](const Context& c) -> double { return c.state.pocket_of(c.state.tool_selected); }},
    Entry{"_value", [](const Context& c) { return c.state.returned_value; }},
    Entry{"_value_returned", [](const Context& c) { return one_if(c.state.value_returned); }},
    Entry{"_task", always_zero},
    Entry{"_call_level", [](const Context& c) -> double { return c.state.call_level(); }},
    Entry{"_remap_level", always_zero},
    Entry{"_vmajor", [](const Context&) { return kVersionMajor; }},
    Entry{"_vminor", [](const Context&) { return kVersionMinor; }},
};

const std::array<std::string_view, kEntries.size()> kEntryNames = [] {
  std::array<std::string_view, kEntries.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kEntries[i].name;
  return names;
}();

}  // namespace

std::span<const std::string_view> predefined_names() { return kEntryNames; }

bool is_predefined(std::int32_t name) { return name < static_cast<std::int32_t>(kEntries.size()); }

double read_predefined(const State& state, std::int32_t name, std::uint32_t line) {
  return kEntries[static_cast<std::size_t>(name)].read({state, line});
}

}  // namespace kadr::gcode
