#pragma once
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gcode/arc.h"
#include "gcode/compensation/compensation.h"
#include "gcode/gcode.h"
#include "gcode/interpret/advice.h"
#include "gcode/interpret/corners.h"
#include "gcode/interpret/passed_blocks.h"
#include "gcode/interpret/state.h"
#include "gcode/interpret/words.h"
#include "gcode/read/report.h"

namespace kadr::gcode {

/// M97, M98, M99 or G65 on a line that was run, or a move under G66.
struct CallRequest {
  bool returns = false;  ///< M99
  bool alone = true;     ///< no other word on its line
  bool to_line = false;  ///< `number` is an N: M97, and M99 with P
  bool macro = false;    ///< G65 and G66: `arguments` are #1 to #33 of the call
  std::vector<double> arguments;
  std::int64_t number = 0;    ///< P
  std::uint64_t repeats = 1;  ///< L
  Span place;
  /// A code of the machine's owner that runs a subroutine; null: M98 or M99.
  const machine::OwnerCode* owner = nullptr;
  std::vector<std::pair<char, double>> words;  ///< of that code
};

/// A required word of a code, and its meaning.
struct NeededWord {
  char letter;
  std::string_view meaning;
};

using Sink = std::function<void(const Block&)>;

/// How fast a straight move goes.
enum class Rate : std::uint8_t { rapid, feed };

/// The points between G5.2 and G5.3: program coordinates, mm.
struct Nurbs {
  bool open = false;
  int order = 3;
  std::vector<SplinePoint> points;
  Span span;             ///< of its first line
  double inverse_f = 0;  ///< F of one of its lines under G93
  bool faulty = false;   ///< an error was reported
  bool doubtful = false;
};

/// Lines -> Blocks. Keeps the settings of earlier lines, checks a whole line before any of it takes
/// effect, then executes its words in the order of RS-274/NGC, whatever order they are written in.
class Interpreter {
 public:
  Interpreter(const InterpretOptions& options, Report& report, const Sink& sink);

  /// Takes the modes of `startup`. Its text joins the sources if something is wrong with it.
  void begin(SourceSet& sources);
  void run(const Line& line);
  // macros.cpp
  /// Runs a line of nothing but settings of macro B, each one before the next.
  void assign(const Line& line);
  /// Reads the inputs of macro B that stand on a line.
  void read_inputs(const Line& line);
  /// Runs a line of G65 or G66.
  void macro_call(const Line& line);
  void cancel_modal_call() { modal_call_.reset(); }
  /// The call that G66 makes behind the line just run; none if that has moved nothing.
  std::optional<CallRequest> modal_call_due();
  /// What was not run as written may have set anything: what depends on it is not judged.
  void lose_track();
  /// The text has ended without M2, M30 or a closing %.
  void text_ran_out(std::uint32_t file);
  /// The program's end if no M2 or M30 gave it.
  void finish(Span end, bool by_percent = false);
  /// The end by M2, M30, or M99 in the main program: modes are reset first.
  void end_program(Span place);
  /// The call requested by the line just run; returned once.
  std::optional<CallRequest> take_call() { return std::exchange(call_, std::nullopt); }
  /// The end of a call: restores its modes if M73 asked for it, and removes its level.
  void leave_level(Span place);
  /// A flow line has been read: the program has begun.
  void start() { started_ = worded_ = true; }
  /// A text joins the program: its lines raise the default bound on blocks.
  /// @param runs_once  nothing repeats or calls any of the texts
  void add_text(std::uint64_t lines, bool runs_once) { text_lines_ += lines, runs_once_ = runs_once; }
  State& state() { return state_; }

  // entry.cpp: a program that is entered at a line of its own
  /// True before that line: blocks are not handed out.
  bool passing() const { return passing_; }
  /// Why the program can't be entered before this line is run; empty: it can.
  std::string not_entered(const Line& line);
  /// Why the program can't be left now; empty: it can.
  std::string not_left() const;
  /// From here on blocks are handed out: first what holds, then the approach, then what waits for the next motion.
  void enter(const Line& line);
  /// Ends the program where it goes on: nothing is reset.
  void leave(Span place);

  /// True after M2, M30, the closing % or the bound on blocks.
  bool ended() const { return ended_; }
  bool ended_by_percent() const { return ended_by_percent_; }

 private:
  // check.cpp: do these words fit together?
  bool check();
  void check_axes();
  void check_unused();
  void check_values();
  void check_motion_words();
  void check_codes();
  void check_call();
  bool calls_number() const;
  std::uint32_t usable_letters() const;
  bool require_word(char letter, GGroup group, std::string_view what);
  bool require_words(const std::vector<NeededWord>& needed, Span span, std::string_view who);
  bool check_whole(char letter, double least, double most);
  void check_shared_p();

  // startup.cpp: before the first line, and what the program does not say
  bool startup_allowed(const Line& line);
  std::uint32_t length_words() const;
  void note_length();
  void tell_units();
  void warn_axis_words_move();
  void warn_without_effect();

  // settings.cpp: modes
  void comment();
  void technology(std::string_view text, Span span);
  void abort_program(std::string text, Span span);
  void feed_mode();
  void feed_rate();
  void plane();
  Plane plane_of_line() const;
  void units();
  void work_system();
  void path_control();
  void set_path_mode(PathMode mode, double tolerance, Span span);
  void distance_mode();
  void parameters();

  // functions.cpp: spindle, coolant, overrides, dwell, stop
  void spindle();
  void orient_spindle();
  void turn_spindle(Turning turning, Span span);
  void coolant();
  void overrides();
  void dwell();
  void stop();
  void call();
  void enable_feed_override(bool enabled);
  void enable_speed_override(bool enabled);
  Span override_span() const;

  // tools.cpp: T, M6 M61, G43 G43.1 G43.2 G49, G10 L1 L10 L11
  void select_tool();
  void change_tool();
  void take_real_position();
  void tool_length();
  const Tool* length_of_tool(int number);
  void set_tool_table();
  AxisValues measured_tool_offset(AxisValues offset, bool in_fixture) const;

  // references.cpp: G10 G28 G30 G52 G92
  void nonmodal();
  void go_to_reference(int parameters);
  void set_offsets();
  void set_work_offset();
  AxisValues measured_work_offset(int system);
  void turn_under_g92(double rotation_deg);
  void set_g92(bool local);
  void set_g92_state();

  // check_offsets.cpp
  void check_axis_words();
  void check_tools();
  bool check_tool(char letter, double least);
  void check_g10();
  void check_g10_tool(int l);
  void check_g10_work_offset(int l);

  // motion.cpp
  void motion();
  Motion motion_of_line() const;
  bool axis_words_taken() const;
  bool moves() const;
  bool motion_sets_mode() const;
  void take_motion(int code);
  AxisValues target() const;
  AxisValues near_position(const AxisValues& wanted) const;
  void straight(Motion motion);
  void go(Rate rate, const AxisValues& program);
  void go_to(Rate rate, const AxisValues& end);
  Move make_move(const AxisValues& end) const;
  Move straight_to(const AxisValues& end);
  void emit_straight(Rate rate, const Move& move);
  void arc(Motion motion);
  /// Where an arc is a circle of its plane: machine coordinates, and program coordinates of X Z and Y Z under
  /// a rotation, which tilts those planes.
  AxisValues arc_frame(const AxisValues& machine) const;
  AxisValues arc_frame_to_machine(const AxisValues& point) const;
  bool find_arc(const AxisValues& start, const AxisValues& end, bool clockwise, ArcGeometry& result);
  bool arc_center_words(PlanePoint& center);
  PlanePoint written_center(bool absolute) const;
  ArcLimits limits_of_arc() const;
  bool refuse_arc(const ArcGeometry& arc, PlanePoint end);
  void explain_off_circle(const ArcGeometry& arc, PlanePoint end, Diagnostic& d) const;
  bool fits_with_other_centers(PlanePoint end) const;
  void warn_nearly_full_circle(PlanePoint from, PlanePoint to, double sweep_rad, double radius_mm, int turns);
  /// "X30 Y12.5" of a point of the arc's plane, as the program would write it.
  std::string arc_point(PlanePoint point) const;
  void warn_arc(const ArcGeometry& arc);
  double rounding_of(char letter) const;
  bool feed_ready();
  void set_feed(Move& move);
  void move_to(const AxisValues& end);

  // splines.cpp: G5 G5.1 G5.2 G5.3
  void spline(Motion motion);
  bool spline_allowed(Motion motion);
  bool spline_place_allowed(std::string_view name);
  double spline_offset(char letter) const;
  void add_control(Spline& spline, AxisValues program, double x_mm, double y_mm, double weight) const;
  void warn_direction_kept();
  void emit_spline(Spline spline, Span span);
  void add_nurbs_point();
  void add_nurbs_control(const AxisValues& program, double weight);
  bool nurbs_words_allowed(bool first);
  void set_nurbs_order();
  void end_nurbs();
  void emit_nurbs(const Nurbs& nurbs);
  void drop_nurbs(Span span);

  // spindle_feed.cpp: S, G96, G97, feeds that follow the spindle
  void spindle_speed();
  void spindle_mode();
  double surface_speed_m_min() const;
  double mean_spindle_rpm(const AxisValues& from, const AxisValues& to) const;
  bool feed_per_turn_ready();
  void warn_standing_spindle();
  void follow_spindle(Move& move);

  // threads.cpp: G33 G33.1
  void check_thread(int code);
  bool spindle_turns(int code);
  void start_thread(double pitch_u_rev);
  void stop_thread();
  void warn_pitch(char letter);
  void thread();
  void rigid_tap();

  // thread_cycle.cpp: G76
  struct ThreadShape;
  void check_thread_cycle();
  void thread_cycle();
  bool thread_shape(ThreadShape& shape, const AxisValues& end);
  void warn_thread(const ThreadShape& shape);
  void thread_pass(const ThreadShape& shape, double depth);

  // cycles.cpp: G73 G74 G81 to G86 G89, G98 G99
  struct Hole;
  void check_cycle(int code);
  bool cycle_allowed();
  void cycle();
  bool cycle_levels(Hole& hole);
  void cycle_holes(Hole hole);
  void make_hole(const Hole& hole);
  void peck(const Hole& hole);
  void tap(const Hole& hole);
  void bore_and_stop(const Hole& hole);
  void tap_to_level(const Hole& hole, double level);
  AxisValues place_at(const Hole& hole, double level) const;
  void go_to_level(const Hole& hole, Rate rate, double level);
  void dwell_at_bottom();
  void retract_mode();

  // probe.cpp: G38.2 to G38.5
  void probe();
  bool probe_allowed();
  double probe_feed_under_inverse_time();
  bool find_contact(Probe& probe, double& travelled);
  bool refuse_probe_start(const Probe& probe, double beyond_mm);
  std::string stock_text() const;
  void keep_probe_result(const Probe& probe);

  // compensation_codes.cpp: G40 G41 G42 G41.1 G42.1
  void compensation();
  void compensation_off();
  bool find_compensation_tool(CompensationTool& tool);
  const Tool* compensation_table_entry();
  void execute_compensated();
  void compensate(const Block& block);
  void hand_out_compensated(Block& block);
  void end_compensation(Span place);
  void report_compensation_fault(const CompensationFault& fault, Span span);

  // compensation_checks.cpp: codes not allowed while compensation is on
  void check_compensation();
  void check_compensation_words();
  void check_while_compensating(bool until_now, bool from_now);
  void refuse_while_compensating(Span span, std::string_view name, std::string_view what);

  // macros.cpp
  void set_macro_variable(int number, double value, Span place);
  void stop_with_message(double value, Span place, bool alarm);
  bool set_tool_variable(int number, double value, Span place);
  void refuse_variable(int number, Span place);
  std::string remark_of_line() const;
  bool macro_words(const Line& line, CallRequest& request);
  bool macro_argument(const Line& line, const Item& item, double value, int& set, CallRequest& request);

  // inputs.cpp: M62 to M68
  void inputs_and_outputs();
  void wait_input();
  InputReading read_input(const InputWait& wait) const;
  void check_functions();
  void check_orientation();
  void check_inputs();
  void check_wait();

  // polar.cpp: @ and ^, X as a diameter
  bool polar_words();
  bool resolve_polar();
  void take_diameters();

  // corner_words.cpp: ,R ,C
  /// A move with ,R or ,C, and what comes between it and the next move.
  struct WaitingCorner {
    CornerWish wish;
    Block move;
    AxisValues start{};
    Plane plane = Plane::xy;
    std::vector<Block> behind;
  };
  void take_corner_word();
  void refuse_corner(Span span, std::string label);
  void emit_at_corner(Block block);
  AxisValues join_at_corner(Block& second);
  void release_corner();

  // dialect_words.cpp: words of the dialect become those of LinuxCNC
  bool take_dialect_words();
  void take_codes_of_dialect();
  void check_dialect_words();
  void take_dwell_words();
  void take_cycle_words();
  void end_cycle();
  void take_radius();
  void take_further_offset();
  void take_extruder();
  double dwell_unit_s(char letter, double unit_s) const;

  // modal_state.cpp: M70 to M73, G7 G8
  void modal_state();
  ModalState modes() const;
  void restore(const ModalState& saved, Span place);
  void run_words(const std::string& words, Span place);
  void diameter_mode();

  // owner_codes.cpp: codes of the machine's owner
  void take_machine_values();
  std::uint32_t owner_letters() const;
  void take_owner_words();
  void check_owner_call();
  void owner_codes();
  void run_owner_code(const machine::OwnerCode& own, Span span);
  void take_time(int code, Span span);

  // interpreter.cpp
  bool plain_move() const;
  bool calls_only() const;
  const Item* words_beside_call() const;
  void execute();
  void apply_modes();
  void recover(bool syntax);
  void emit(Span span, Action action);
  void pass_on(Block& block);
  void hand_out(Block& block);
  bool block_allowed(Span span, std::size_t waiting);
  bool message_allowed(Span span, std::size_t bytes);
  std::vector<std::string> ways_to(const AxisValues& place) const;
  bool refuse_passed_probe();
  Span line_span() const;
  Span action_span() const;
  Span g_span(GGroup group) const { return words_.span(*line_, group); }
  bool error(Diagnostic d);

  const InterpretOptions& options_;
  const DialectRules& rules_;
  Report& report_;
  const Sink& sink_;
  State state_;
  Advice advice_;
  OwnerTable owner_table_;
  Words words_;
  std::vector<std::pair<char, double>> owner_words_;  ///< of the line, those of its codes of the owner
  std::optional<CallRequest> call_;
  std::optional<CallRequest> modal_call_;  ///< G66
  std::size_t modal_level_ = 0;            ///< the call level of G66
  Evaluator evaluator_;                    ///< of settings and arguments of macro B
  std::optional<CornerWish> corner_wish_;  ///< of this line
  std::optional<WaitingCorner> corner_;
  AxisValues move_from_{};     ///< where the motion of this line begins, in dialects with corners
  std::optional<Span> place_;  ///< of blocks while modes are restored
  Compensation compensation_;
  bool compensation_tilted_ = false;     ///< it runs in program coordinates: G18 in a rotated work system
  Span compensation_span_;               ///< the G41 or G42 in force
  std::size_t compensation_faults_ = 0;  ///< reported on this line
  const Line* line_ = nullptr;
  std::set<int> unknown_lengths_;  ///< tools whose length was taken as 0
  Nurbs nurbs_;
  double spline_i_mm_ = 0;  ///< from the start to the first control point of a G5 without I and J
  double spline_j_mm_ = 0;
  std::optional<AxisValues> spline_end_;  ///< of the last G5
  AxisValues last_move_end_{};            ///< of the last line, arc or tap
  std::optional<AxisValues> tapped_at_;   ///< where the last tap ended for the program: not where the tool is
  std::optional<AxisValues> probe_left_;  ///< where the last G38.4 or G38.5 lost contact
  bool probe_stock_told_ = false;
  std::uint32_t axes_on_machine_ = 0;
  std::uint64_t blocks_ = 0;
  std::uint64_t messages_ = 0;    ///< weighed
  std::uint64_t text_lines_ = 0;  ///< of all texts read
  bool runs_once_ = false;        ///< each line at most once: its messages need no bound
  bool started_ = false;          ///< some line with words has been run, or the opening % was seen
  bool ended_ = false;
  bool ended_by_percent_ = false;
  bool worded_ = false;            ///< some line with words has been run
  Span opened_;                    ///< the % that opens the program; line 0: none
  bool units_pending_ = false;     ///< neither G20 nor G21 so far, and no length
  Span length_;                    ///< the first length without units; line 0: none
  std::string length_text_;        ///< "X5 is taken as 5 mm"
  std::string units_later_;        ///< "G20 follows on line 7"
  bool diameters_begin_ = false;   ///< G7 on this line has ended G8
  bool threading_ = false;         ///< feed moves follow the spindle's angle, by thread_pitch_u_rev_
  double thread_pitch_u_rev_ = 0;  ///< as written
  bool standing_told_ = false;     ///< the warning of a feed that follows a stopped spindle
  bool passing_ = false;           ///< the line where the program is entered is yet to come
  bool left_ = false;              ///< the program was ended where it goes on
  PassedBlocks passed_;
  bool silent_ = false;  ///< recovering from an error: modes are taken over, nothing is handed out
};

}  // namespace kadr::gcode
