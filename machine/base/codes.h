#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kadr {

/// Stable number of a diagnostic, printed as K2107. Never reused. Ranges: K1xxx reading, K2xxx geometry,
/// K3xxx machine and scenario files, K4xxx planning and limits, K5xxx motion and plant, K9xxx internal.
/// The texts are in machine/base/codes/<range>.inc, which codes.cpp alone reads: an edited text rebuilds
/// one object, and a code without a text does not compile there.
enum class Code : std::uint16_t {
  // K1xxx reading a control program (codes/reading.inc)
  bad_character = 1001,
  comment_not_closed = 1002,
  comment_nested = 1003,
  number_missing = 1004,
  decimal_comma = 1005,
  bad_number = 1006,
  bracket_not_closed = 1007,
  operator_expected = 1008,
  unknown_name = 1009,
  argument_missing = 1010,
  expression_too_deep = 1011,
  not_utf8 = 1012,
  text_after_percent = 1013,
  equals_missing = 1016,
  too_many_errors = 1017,
  comment_not_run = 1018,
  line_number_place = 1019,
  encoding_other = 1060,
  carriage_return = 1061,
  kind_other = 1062,
  program_empty = 1063,
  program_cut = 1064,

  // K1020 to K1059 control flow: subroutines, loops, conditions, named parameters, files, bounds, macro B (codes/flow.inc)
  o_word_place = 1020,
  text_after_o_word = 1021,
  o_keyword_unknown = 1022,
  o_label_missing = 1023,
  o_arguments = 1024,
  o_not_closed = 1025,
  o_not_opened = 1026,
  o_label_twice = 1027,
  o_misplaced = 1028,
  o_label_computed = 1029,
  name_not_set = 1030,
  name_not_closed = 1031,
  name_bad = 1032,
  sub_not_found = 1033,
  sub_kind = 1034,
  sub_file = 1035,
  sub_without_end = 1036,
  main_again = 1037,
  loop_mark_kept = 1038,
  calls_too_deep = 1040,
  loop_too_long = 1041,
  file_too_large = 1042,
  line_too_long = 1043,
  too_many_lines = 1044,
  sub_of_other_file = 1045,
  program_aborts = 1046,
  macro_statement = 1050,
  macro_loop = 1051,
  sequence_number_missing = 1052,
  sequence_number_twice = 1053,
  jump_into_loop = 1054,
  system_variable = 1055,
  macro_argument = 1056,

  // K1070 to K1079 where a program is entered and left (codes/line_range.inc)
  entry_line = 1070,
  exit_line = 1071,
  entry_probe = 1072,

  // K1xxx reading a control program: words and codes (codes/reading.inc)
  word_not_run = 1101,
  unknown_code = 1102,
  word_repeated = 1103,
  modal_conflict = 1104,
  word_unused = 1105,
  word_missing = 1106,
  word_not_whole = 1107,
  word_out_of_range = 1108,
  axis_not_on_machine = 1109,
  axis_words_without_motion = 1110,
  axis_words_wanted_twice = 1111,
  tool_length_unknown = 1112,
  word_shared = 1113,
  long_dwell = 1114,
  reference_by_below = 1115,
  cut_without_spindle = 1116,
  spindle_left_running = 1117,
  words_behind_end = 1118,
  length_of_other_tool = 1119,

  // K1120 to K1159 tools, offsets, inputs and outputs, modal state, polar words, dialects
  // (codes/functions.inc)
  tool_unknown = 1120,
  axis_words_shared = 1121,
  tool_offset_unclear = 1122,
  tool_table_busy = 1123,
  rotation_under_g92 = 1124,
  units_unsaid = 1125,
  axis_words_move = 1126,
  word_without_effect = 1127,
  startup_word = 1128,
  input_unclear = 1129,
  modal_state_missing = 1130,
  polar_and_axis = 1131,
  polar_origin = 1132,
  polar_place = 1133,
  dialect_refuses = 1134,
  word_told = 1135,
  controller_line = 1136,
  checksum_wrong = 1137,
  dialect_recognised = 1138,
  corner_place = 1139,
  code_passed_over = 1140,
  owner_code_taken = 1141,
  owner_code_line = 1142,
  value_not_given = 1143,
  ini_line = 1144,
  tool_table_word = 1150,
  tool_table_number = 1151,
  tool_table_missing = 1152,
  tool_table_repeated = 1153,
  tool_table_tool_twice = 1154,
  tool_table_pocket_twice = 1155,
  tool_table_range = 1156,

  // K1xxx reading a control program: values (codes/reading.inc)
  technology_comment = 1157,
  parameter_never_set = 1160,
  division_by_zero = 1201,
  function_domain = 1202,
  parameter_range = 1203,
  parameter_read_only = 1204,
  value_too_large = 1205,
  too_many_blocks = 1301,
  too_many_messages = 1302,

  // K2xxx geometry of blocks (codes/geometry.inc)
  feed_missing = 2101,
  feed_zero = 2102,
  inverse_feed_missing = 2103,
  g53_misplaced = 2104,
  arc_center_missing = 2105,
  arc_offset_outside_plane = 2106,
  arc_end_off_circle = 2107,
  arc_radius_too_small = 2108,
  arc_radius_zero = 2109,
  arc_radius_undetermined = 2110,
  arc_format_mixed = 2111,
  arc_by_tolerance = 2112,
  feed_before_units = 2113,
  feed_cleared = 2114,
  arc_full_circle = 2115,

  // K2120 to K2139 canned cycles (codes/cycles.inc)
  cycle_retract_below_bottom = 2120,
  cycle_under_inverse_time = 2121,
  cycle_axis_refused = 2123,
  cycle_spindle = 2124,
  tap_outside_g17 = 2125,

  // K2140 to K2159 cutter compensation (codes/compensation.inc)
  compensation_conflict = 2140,
  compensation_twice = 2141,
  compensation_plane = 2142,
  compensation_tool_unknown = 2143,
  compensation_lathe_tool = 2144,
  compensation_entry_short = 2145,
  compensation_entry_arc = 2146,
  compensation_arc_small = 2147,
  compensation_gouge = 2148,
  compensation_no_meeting = 2149,
  compensation_exit_arc = 2150,
  compensation_radius_zero = 2151,
  compensation_orientation_unread = 2152,

  // K2160 to K2199 splines, spindle-synchronous moves, threads, probing (codes/curves.inc)
  thread_spindle_stopped = 2160,
  thread_with_feed = 2161,
  thread_depth = 2162,
  thread_axis_refused = 2163,
  thread_passes = 2164,
  feed_of_standing_spindle = 2165,
  feed_without_speed = 2166,
  thread_unusual = 2167,
  spline_plane = 2170,
  spline_axis = 2171,
  spline_direction_old = 2172,
  nurbs_point = 2173,
  nurbs_not_open = 2174,
  nurbs_too_few_points = 2175,
  nurbs_dropped = 2176,
  nurbs_order = 2177,
  probe_too_short = 2180,
  probe_feed_mode = 2181,
  probe_no_contact = 2182,
  probe_already_there = 2183,
  probe_without_stock = 2184,

  // K3xxx machine, scenario and problem files (codes/files.inc)
  file_syntax = 3001,
  file_format = 3002,
  file_unknown_key = 3003,
  file_other_unit = 3004,
  file_missing_key = 3005,
  file_wrong_type = 3006,
  file_unknown_word = 3007,
  file_out_of_range = 3008,
  file_not_finite = 3009,
  file_setting = 3010,
  file_keys_exclude = 3011,
  file_duplicate_key = 3012,
  file_too_deep = 3013,
  file_outside = 3014,
  machine_no_axis = 3101,
  machine_duplicate_axis = 3102,
  machine_axis_letter = 3103,
  machine_axis_kind = 3104,
  machine_clock = 3105,
  machine_control_period = 3106,
  machine_long_period = 3107,
  machine_step_rate = 3108,
  machine_range_order = 3109,
  machine_outside_range = 3110,
  machine_oracle_motor = 3111,
  machine_stock_axis = 3112,
  machine_technology = 3113,
  machine_rapid_law = 3114,
  machine_approach = 3120,
  machine_code = 3121,
  scenario_file_missing = 3201,
  scenario_program = 3202,
  scenario_step = 3203,
  scenario_value = 3204,
  scenario_technology = 3205,
  problem_path = 3301,
  problem_table = 3302,
  problem_zone = 3303,
  problem_too_large = 3304,
  problem_no_motion = 3305,
  problem_program = 3306,
  problem_fit = 3307,

  // K4xxx planning and limits (codes/planning.inc)
  feed_not_plannable = 4001,
  limit_not_plannable = 4002,
  motion_too_long = 4003,
  arc_axis_missing = 4004,
  spindle_stands_still = 4005,
  arc_plane_turned = 4006,
  quintic_without_jerk = 4007,
  law_not_found = 4008,
  thread_too_fast = 4009,
  soft_limit = 4101,
  wait_timed_out = 4102,
  output_without_motion = 4103,

  // K5xxx motion, plant and log (codes/motion.inc)
  soft_limit_overrun = 5101,
  speed_overrun = 5102,
  acceleration_overrun = 5103,
  jerk_overrun = 5104,
  lost_steps = 5105,
  emergency_stopped = 5106,
  overload_locked = 5107,
  held_to_the_end = 5108,
  plant_numerics = 5201,

  // K9xxx kadr's own faults (codes/internal.inc)
  broken_promise = 9001,
};

struct CodeEntry {
  Code code;
  std::string_view name;         ///< identifier, snake_case
  std::string_view title;        ///< headline of the diagnostic, lower case, no full stop
  std::string_view explanation;  ///< what `kadr explain` prints: cause, example, what to do
};

/// All codes in ascending order.
std::span<const CodeEntry> all_codes();
const CodeEntry& code_entry(Code code);
/// "K2107"
std::string code_name(Code code);
/// Reads "K2107" or "2107"; nothing if there is no such code.
std::optional<Code> parse_code(std::string_view text);

}  // namespace kadr
