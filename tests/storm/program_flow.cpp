#include <fmt/format.h>

#include "tests/storm/program_draw.h"

namespace kadr::storm {

std::string ProgramDraw::label() {
  const int number = ++labels_;
  return d_.chance(0.7) ? fmt::format("o{}", number) : fmt::format("o<label {}>", number);
}

void ProgramDraw::body(int statements) {
  for (int i = 0; i < statements; ++i) {
    switch (d_.whole(0, 4)) {
      case 0:
        dwell();
        break;
      case 1: {
        const int target = d_.whole(31, 35);
        line(fmt::format("#{}=[[{}] MOD 100]", target, w_.expression(1)));
        break;
      }
      default:
        simple();
    }
  }
}

void ProgramDraw::condition() {
  const std::string name = label();
  const std::string left = w_.parameter();
  line(fmt::format("{} if [{} {} 3]", name, left, d_.pick({"GT", "LT", "GE", "LE", "EQ", "NE"})));
  body(d_.whole(1, 2));
  if (d_.chance(0.4)) {
    line(name + " elseif [#2 LT 1]");
    body(1);
  }
  if (d_.chance(0.5)) {
    line(name + " else");
    body(1);
  }
  line(name + " endif");
}

void ProgramDraw::loop() {
  const std::string name = label();
  const int passes = d_.whole(0, 4);
  line("#20=0");
  const int kind = d_.whole(0, 2);
  if (kind == 0) line(fmt::format("{} while [#20 LT {}]", name, passes));
  if (kind == 1) line(name + " do");
  if (kind == 2) line(fmt::format("{} repeat [{}]", name, passes));
  line("#20=[#20+1]");
  body(1);
  if (d_.chance(0.3)) {
    const std::string test = label();
    line(test + " if [#20 EQ 2]");
    line(name + (d_.chance(0.5) ? " break" : " continue"));
    line(test + " endif");
  }
  body(1);
  if (kind == 0) line(name + " endwhile");
  if (kind == 1) line(fmt::format("{} while [#20 LT {}]", name, passes));
  if (kind == 2) line(name + " endrepeat");
}

void ProgramDraw::call() {
  const std::string argument = plain(d_.real(-1, 1), 3);
  if (subprograms_ > 0 && d_.chance(0.5)) {
    std::string text = fmt::format("M98 P{}", 900 + d_.whole(1, subprograms_));
    if (d_.chance(0.4)) text += fmt::format(" L{}", d_.whole(1, 3));
    line(text);
  } else if (file_sub_ && d_.chance(0.4)) {
    line("o<beside> call [" + argument + "]");
  } else if (subs_ > 0) {
    line(fmt::format("o{} call [{}] [2]", 100 + d_.whole(1, subs_), argument));
  }
}

/// Subroutines before the program's first statement, and one in a file beside.
void ProgramDraw::define_subs() {
  const auto moves = [&] {
    const char letter = d_.letter_of(m_.letters);
    const std::string words = fmt::format("{}[#1*{}]", letter, length(0.3 * m_.scale.move_u, letter));
    line("G91 G1 " + words);
    if (d_.chance(0.3)) line("G4 P" + plain(m_.scale.tau_s));
    line(modes_.incremental ? "G91" : "G90");
  };
  const int subs = d_.chance(0.3) ? d_.whole(1, 2) : 0;
  for (int i = 1; i <= subs; ++i) {
    line(fmt::format("o{} sub", 100 + i));
    if (!shop() && d_.chance(0.3)) line("M73");
    moves();
    if (d_.chance(0.3)) {
      line("o90 if [#1 GT 0.5]");
      line(fmt::format("o{} return [#1]", 100 + i));
      line("o90 endif");
    }
    line(fmt::format("o{} endsub{}", 100 + i, d_.chance(0.4) ? " [#1+1]" : ""));
  }
  subs_ = subs;
  if (!d_.chance(0.12)) return;
  std::string text;
  out_ = &text;
  line("o<beside> sub");
  moves();
  line("o<beside> endsub");
  if (d_.chance(0.5)) line("M2");
  out_ = &text_;
  program_.files["beside.ngc"] = text;
  file_sub_ = true;
}

void ProgramDraw::end() {
  if (rubbish_ && d_.chance(0.3)) rubbish();
  if (subprograms_ == 0 && d_.chance(0.1)) return;
  line(d_.chance(0.8) ? "M2" : "M30");
  for (int i = 1; i <= subprograms_; ++i) {
    line(fmt::format("O{}", 900 + i));
    const char letter = d_.letter_of(m_.letters);
    const std::string words = letter + length(0.2 * some_u(), letter);
    line("G91 G1 " + words);
    line(modes_.incremental ? "G91" : "G90");
    line("M99");
  }
}

}  // namespace kadr::storm
