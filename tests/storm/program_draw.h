#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "tests/gcode/rs274_writer.h"
#include "tests/storm/random_program.h"

namespace kadr::storm {

/// Draws the statements of a program; each leaves the modes as `modes_` says.
class ProgramDraw {
 public:
  ProgramDraw(Draw& draw, const RandomMachine& machine);
  RandomProgram make();

 private:
  using Statement = void (ProgramDraw::*)();
  /// Plane of two linear axes that the machine has.
  struct Plane {
    std::string code;
    char first, second, normal;
  };
  struct Modes {
    bool incremental = false, inches = false, absolute_centers = false;
    Plane plane{"G17", 'X', 'Y', 'Z'};
    double per_minute = 1000;  ///< F
  };

  void add(Statement statement, int times = 1) { statements_.insert(statements_.end(), times, statement); }
  void line(const std::string& text) { *out_ += text + "\n"; }
  bool has(std::string_view letters) const;
  bool grbl() const { return program_.dialect == "grbl"; }
  bool shop() const { return program_.dialect == "fanuc" || program_.dialect == "haas"; }
  double some_u() { return m_.scale.move_u * d_.real(-1, 1); }
  /// A length of the program: mm or degrees in its unit.
  std::string length(double value_u, char letter = 'X') const;
  /// "X..": to a point that lies so far from the present one.
  std::string to(char letter, double delta_u);
  /// The same, written by an expression now and then.
  std::string spelled(char letter, double delta_u);
  std::string feed(double share);
  double rpm(double share, double per_turn_u) const;

  // program_moves.cpp
  void straight();
  void simple();
  void arc();
  void circle();
  void chain();
  void polar();
  void spline();
  void nurbs();
  void contour();
  void thread();
  void thread_cycle();
  void cycle();
  void tapping();
  void probe();
  void inverse_time();
  void per_turn();
  // program_codes.cpp
  void modes();
  void path_mode();
  void diameter();
  void offsets();
  void rotation();
  void references();
  void functions();
  void outputs();
  void dwell();
  void parameters();
  void tools();
  void stored();
  void dialect_words();
  void rubbish();
  // program_flow.cpp
  void condition();
  void loop();
  void call();
  void define_subs();
  void end();
  std::string label();
  void body(int statements);

  Draw& d_;
  gcode::test::Writer w_;
  const RandomMachine& m_;
  RandomProgram program_;
  std::string text_;
  std::string* out_ = &text_;
  std::vector<Statement> statements_;
  std::vector<Plane> planes_;
  Modes modes_;
  std::string linear_;  ///< letters of linear axes
  bool turned_ = false, rubbish_ = false, tools_given_ = false, in_flow_ = false;
  int labels_ = 0, subs_ = 0, subprograms_ = 0;
  bool file_sub_ = false;
};

}  // namespace kadr::storm
