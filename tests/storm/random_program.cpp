#include "tests/storm/random_program.h"

#include <algorithm>
#include <iterator>

#include "tests/storm/program_draw.h"
#include "tests/storm/storm_case.h"

namespace kadr::storm {

ProgramDraw::ProgramDraw(Draw& draw, const RandomMachine& machine) : d_(draw), w_(draw), m_(machine) {
  for (const char letter : m_.letters)
    if (!m_.rotary(letter)) linear_ += letter;
  program_.dialect =
      d_.pick<std::string>({"linuxcnc", "linuxcnc", "linuxcnc", "grbl", "mach3", "marlin", "fanuc", "haas"});
  if (has("XY")) planes_.push_back({"G17", 'X', 'Y', 'Z'});
  if (has("XZ")) planes_.push_back({"G18", 'Z', 'X', 'Y'});
  if (has("YZ")) planes_.push_back({"G19", 'Y', 'Z', 'X'});
  add(&ProgramDraw::straight, 6);
  if (grbl()) {
    // no expressions, and few codes
    add(&ProgramDraw::dwell);
    if (!planes_.empty()) add(&ProgramDraw::arc, 3);
    return;
  }
  add(&ProgramDraw::chain, 2);
  add(&ProgramDraw::modes, 2);
  add(&ProgramDraw::path_mode);
  add(&ProgramDraw::functions, 2);
  add(&ProgramDraw::dwell);
  add(&ProgramDraw::parameters);
  add(&ProgramDraw::inverse_time);
  if (!planes_.empty()) {
    add(&ProgramDraw::arc, 5);
    add(&ProgramDraw::circle);
  }
  // a program has some of the other subjects, so that each meets few others
  static constexpr Statement kSubjects[] = {
      &ProgramDraw::polar,        &ProgramDraw::spline,       &ProgramDraw::nurbs,    &ProgramDraw::contour,
      &ProgramDraw::thread,       &ProgramDraw::thread_cycle, &ProgramDraw::cycle,    &ProgramDraw::tapping,
      &ProgramDraw::probe,        &ProgramDraw::per_turn,     &ProgramDraw::diameter, &ProgramDraw::offsets,
      &ProgramDraw::rotation,     &ProgramDraw::references,   &ProgramDraw::outputs,  &ProgramDraw::tools,
      &ProgramDraw::stored,       &ProgramDraw::condition,    &ProgramDraw::loop,     &ProgramDraw::call,
      &ProgramDraw::dialect_words};
  static constexpr Statement kNotOfShops[] = {&ProgramDraw::spline, &ProgramDraw::nurbs,
                                              &ProgramDraw::thread_cycle, &ProgramDraw::diameter,
                                              &ProgramDraw::stored};
  for (const Statement subject : kSubjects) {
    const bool refused =
        shop() && std::find(std::begin(kNotOfShops), std::end(kNotOfShops), subject) != std::end(kNotOfShops);
    if (d_.chance(0.3) && !refused) add(subject, 2);
  }
}

RandomProgram ProgramDraw::make() {
  rubbish_ = d_.chance(0.02);
  if (d_.chance(0.4)) {
    tools_given_ = true;
    const char letter = m_.has('Z') ? 'Z' : m_.letters[0];
    std::string& table = program_.files[kToolsFile];
    for (const int number : {1, 2, 9}) {
      const std::string offset = plain(0.5 * some_u());
      const double diameter = m_.scale.move_u * d_.decades(0.01, 0.1);
      table += fmt::format("T{} P{} {}{} D{} ;tool\n", number, number, letter, offset, plain(diameter));
    }
  }
  if (!grbl()) define_subs();
  if (!grbl() && !file_sub_ && d_.chance(0.12)) subprograms_ = d_.whole(1, 2);
  const bool fanuc = program_.dialect == "fanuc";
  modes_.incremental = grbl();
  std::string head = fanuc ? "G71 G90 G94 " : grbl() ? "G21 G91 G94 " : "G21 G90 G94 ";
  if (!planes_.empty()) {
    modes_.plane = planes_.front();
    head += modes_.plane.code + " ";
  }
  line(head + feed(d_.decades(0.1, 1.2)));
  for (int n = d_.whole(1, 12); n > 0; --n) {
    (this->*statements_[d_.below(statements_.size())])();
    if (rubbish_ && d_.chance(0.1)) rubbish();
  }
  end();
  program_.files[kProgramFile] = text_;
  program_.lines = static_cast<int>(std::count(text_.begin(), text_.end(), '\n'));
  return std::move(program_);
}

RandomProgram random_program(Draw& draw, const RandomMachine& machine) {
  return ProgramDraw(draw, machine).make();
}

}  // namespace kadr::storm
