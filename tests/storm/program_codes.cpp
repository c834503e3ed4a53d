#include <fmt/format.h>

#include "tests/gcode/random_lines.h"
#include "tests/storm/program_draw.h"

namespace kadr::storm {

void ProgramDraw::modes() {
  switch (d_.whole(0, 6)) {
    case 0:
      if (planes_.empty()) return;
      modes_.plane = planes_[d_.below(planes_.size())];
      line(modes_.plane.code);
      break;
    case 1:
      // U V W in degrees would be scaled as inches are
      if (!m_.turning.empty() && m_.turning.back() >= 'U') return;
      modes_.inches = !modes_.inches;
      if (program_.dialect == "fanuc")
        line(modes_.inches ? "G70" : "G71");
      else
        line(modes_.inches ? "G20" : "G21");
      line(feed(d_.decades(0.1, 1)));
      break;
    case 2:
      modes_.absolute_centers = !modes_.absolute_centers;
      line(modes_.absolute_centers ? "G90.1" : "G91.1");
      break;
    case 3:
      line(feed(d_.decades(0.01, 2)));
      break;
    default:
      modes_.incremental = !modes_.incremental;
      line(modes_.incremental ? "G91" : "G90");
  }
}

void ProgramDraw::path_mode() {
  const double within = m_.scale.move_u * d_.decades(1e-3, 0.1);
  switch (d_.whole(0, 5)) {
    case 0:
      line("G61");
      break;
    case 1:
      line("G61.1");
      break;
    case 2:
      line("G64");
      break;
    case 3: {
      const std::string text = "G64 P" + length(within);
      line(text + " Q" + length(within * d_.real(0.1, 1)));
      break;
    }
    default:
      line("G64 P" + length(within));
  }
}

void ProgramDraw::diameter() {
  if (!m_.has('X')) return;
  line("G7");
  line(fmt::format("G1 X[2*[#5420+{}]]", length(0.3 * some_u())));
  line("G8");
}

void ProgramDraw::offsets() {
  std::string words;
  for (const char letter : m_.letters)
    if (words.empty() || d_.chance(0.4)) words += " " + (letter + length(some_u(), letter));
  switch (d_.whole(0, 8)) {
    case 0:
      line(fmt::format("G10 L2 P{}", d_.whole(0, 9)) + words);
      break;
    case 1:
      line(fmt::format("G10 L20 P{}", d_.whole(shop() ? 1 : 0, 9)) + words);
      break;
    case 2:
      line("G92" + words);
      break;
    case 3:
      line(d_.pick<std::string>({"G92.1", "G92.2", "G92.3"}));
      break;
    case 4:
      line("G52" + words);
      break;
    case 5:
      line("G43.1" + words);
      break;
    case 6:
      line("G49");
      break;
    default:
      line("G" + d_.pick<std::string>({"54", "55", "56", "57", "58", "59", "59.1", "59.2", "59.3"}));
  }
}

void ProgramDraw::rotation() {
  if (!has("XY") || modes_.plane.code != "G17") return;
  line("G10 L2 P0 R" + plain(d_.real(-180, 180), 3));
  turned_ = true;
}

void ProgramDraw::references() {
  switch (d_.whole(0, 4)) {
    case 0:
      line("G28");
      break;
    case 1:
      line("G30");
      break;
    case 2:
      line("G28.1");
      break;
    case 3:
      line("G30.1");
      break;
    default: {
      if (modes_.incremental) return;
      const char letter = d_.letter_of(m_.letters);
      line("G53 G0 " + (letter + length(some_u(), letter)));
    }
  }
}

void ProgramDraw::dwell() {
  double seconds = m_.scale.tau_s * d_.whole(0, 30);
  if (d_.chance(0.2)) seconds += m_.scale.tau_s * d_.real(0, 1);
  if (program_.dialect == "marlin" && d_.chance(0.5))
    line("G4 S" + plain(seconds));
  else if (program_.dialect == "fanuc" && d_.chance(0.5))
    line("G4 X" + plain(seconds));
  else if (program_.dialect == "haas")
    line(fmt::format("G4 P{:.0f}", seconds * 1e3));  // a point would mean seconds
  else
    line("G4 P" + plain(program_.dialect == "linuxcnc" || grbl() ? seconds : seconds * 1e3));
}

void ProgramDraw::functions() {
  static const char* const kLines[] = {"M7",
                                       "M8",
                                       "M9",
                                       "M3 S500",
                                       "M4 S800",
                                       "M5",
                                       "M48",
                                       "M49",
                                       "M50 P0",
                                       "M50 P1",
                                       "M51 P0",
                                       "M51 P1",
                                       "M52 P1",
                                       "M53 P1",
                                       "M0",
                                       "M1",
                                       "M60",
                                       "S1234.5",
                                       "(MSG, storm)",
                                       "(plain)",
                                       "; rest",
                                       "/ M9",
                                       "G40",
                                       "M19 R45",
                                       "M3 M8",
                                       "G0",
                                       "G80",
                                       "G49",
                                       "(DEBUG, #1 #5420)",
                                       "(PRINT, #<_feed>)",
                                       "N20 M9",
                                       "M48 M9",
                                       "G91.1",
                                       "$0 M5",
                                       "G61 (exact)"};
  const std::string text = kLines[d_.below(std::size(kLines))];
  // of Haas these are others' codes
  if (program_.dialect == "haas" &&
      (text.rfind("M48", 0) == 0 || text.rfind("M49", 0) == 0 || text.rfind("M5", 0) == 0) && text != "M5")
    return;
  if (text == "G91.1") modes_.absolute_centers = false;
  line(text);
}

void ProgramDraw::outputs() {
  const int n = d_.whole(0, 3);
  std::string text;
  switch (d_.whole(0, 6)) {
    case 0:
      line(fmt::format("M66 P{} L0", n));
      program_.waits = true;
      break;
    case 1:
      text = fmt::format("M66 P{} L{} Q", n, d_.whole(1, 4));
      line(text + plain(m_.scale.tau_s * d_.pick({1, 7, 30})));
      program_.waits = true;
      break;
    case 2:
      line(fmt::format("M67 E{} Q", n) + plain(d_.real(-10, 10), 3));
      break;
    case 3:
      line(fmt::format("M68 E{} Q", n) + plain(d_.real(-10, 10), 3));
      break;
    case 4:
      line("(TECH s_max=" + plain(m_.scale.speed_u_s * d_.decades(0.1, 1)) + ")");
      break;
    default:
      line(d_.pick<std::string>({"M62 P", "M63 P", "M64 P", "M65 P"}) + std::to_string(n));
  }
}

void ProgramDraw::parameters() {
  switch (d_.whole(0, 3)) {
    case 0: {
      const std::string target = w_.settable_parameter();
      line(fmt::format("{}=[[{}] MOD 100]", target, w_.expression(2)));
      break;
    }
    case 1:
      line(fmt::format("#{}=[#1+3] #4=#2", d_.whole(1, 5)));
      break;
    case 2:
      line("(DEBUG, #1 #<_feed> #<_metric> #<_call_level> #5420)");
      break;
    default: {
      const char letter = d_.letter_of(m_.letters);
      line(fmt::format("#7=[SIN[{}]*{}]", w_.expression(1), length(m_.scale.move_u, letter)));
      line(fmt::format("G1 {}",
                       modes_.incremental ? fmt::format("{}#7", letter) : to(letter, 0).insert(2, "#7+")));
    }
  }
}

void ProgramDraw::tools() {
  const int number = tools_given_ ? d_.pick({1, 2, 9}) : d_.whole(1, 9);
  switch (d_.whole(0, 7)) {
    case 0:
      line(fmt::format("T{} M6", number));
      break;
    case 1:
      line(fmt::format("M6 T{}", number));
      break;
    case 2:
      line(fmt::format("T{}", number));
      break;
    case 3:
      line(fmt::format("M61 Q{}", number));
      break;
    case 4:
      line(tools_given_ ? fmt::format("G43 H{}", number)
                        : "G43.1 " + (m_.letters[0] + length(some_u(), m_.letters[0])));
      break;
    case 5:
      line(tools_given_ ? fmt::format("G43.2 H{}", number) : "G49");
      break;
    case 6:
      if (tools_given_)
        line(fmt::format("G10 L1 P{} {}{}", number, m_.letters[0], length(some_u(), m_.letters[0])));
      break;
    default:
      line("G49");
  }
}

void ProgramDraw::stored() {
  line("M70");
  simple();
  line(d_.chance(0.8) ? "M72" : "M71");
}

void ProgramDraw::dialect_words() {
  if (program_.dialect == "marlin" && has("XY")) {
    line("G17");
    modes_.plane = planes_.front();
    std::string text = "G5 P" + length(some_u()) + " ";
    text += "Q" + length(some_u()) + " ";
    text += to('X', some_u()) + " ";
    line(text + to('Y', some_u()));
  } else {
    dwell();
  }
}

void ProgramDraw::rubbish() { line(gcode::test::random_line(d_)); }

}  // namespace kadr::storm
