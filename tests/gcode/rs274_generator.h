#pragma once
#include <string>
#include <vector>

#include "gcode/block.h"
#include "rs274_oracle.h"
#include "rs274_writer.h"

namespace kadr::gcode::test {

/// Subjects of a generated program besides straight moves, arcs, planes, units and distance modes.
struct Subjects {
  bool offsets = false;   ///< G10 L2 L20, G92 family, G54 .. G59.3, G43.1, G28 G30
  bool rotation = false;  ///< G10 L2 R, G52
  bool machine = false;   ///< spindle, coolant, overrides, dwell, path mode, feed modes
  bool polar = false;
  bool tools = false;    ///< T M6 M61 G43 (.1 .2) G49
  bool turning = false;  ///< G95 G96 G97 G7 G8
  bool outputs = false;  ///< M62 to M68
  bool stored = false;   ///< M70 M71 M72
  bool cycles = false;   ///< G73 G81 .. in all planes
  bool splines = false;
  bool threads = false;  ///< G33 G33.1
  bool probes = false;
};

/// Random valid programs. Follows the modes that decide what may come next; positions are taken from #5420..
/// so that arcs fit whatever the offsets, units and distance mode.
class Generator {
 public:
  Generator(Random& random, const Subjects& subjects);
  TestProgram program();

 private:
  /// The modes in force, as M70 stores them.
  struct Modes {
    Plane plane = Plane::xy;
    bool incremental = false, absolute_centers = false;
    bool inverse = false, per_turn = false;
    bool diameter = false, inches = false;
  };
  using Statement = void (Generator::*)();

  void add(Statement statement, int times = 1) { statements_.insert(statements_.end(), times, statement); }
  std::string number(double low, double high) { return w_.number(low, high); }
  std::string value(double low, double high);
  /// Word of an axis that lies `delta` from the present point.
  std::string word(int axis, const std::string& delta) const;
  std::string axes(const std::vector<std::string>& letters, double chance);

  void straight();
  void arc();
  std::string arc_center(double i, double j, const PlaneAxes& axes);
  void plane();
  void units();
  void distance();
  void feed_mode();
  void feed();
  void work_offset();
  void reference();
  void machine_coordinates();
  void machine_function();
  void parameters();
  void rotation();
  void polar();
  void tool();
  void turning();
  void output();
  void store();
  void cycle();
  void spline();
  void thread();
  void probe();

  Random& random_;
  Writer w_;
  Subjects subjects_;
  std::vector<Statement> statements_;
  std::string text_;
  Modes modes_, stored_;
  bool is_stored_ = false;
  bool number_set_ = false;  ///< M61 since the last M6: rs274 keeps the old tool's data
};

}  // namespace kadr::gcode::test
