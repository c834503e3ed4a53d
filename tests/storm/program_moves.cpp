#include <cmath>

#include "tests/storm/program_draw.h"

namespace kadr::storm {

namespace {
constexpr double kInch_mm = 25.4;
constexpr std::string_view kLetters = "XYZABCUVW";  // #5420 and those behind it
}  // namespace

bool ProgramDraw::has(std::string_view letters) const {
  for (const char letter : letters)
    if (!m_.has(letter)) return false;
  return true;
}

std::string ProgramDraw::length(double value_u, char letter) const {
  return plain(modes_.inches && !m_.rotary(letter) ? value_u / kInch_mm : value_u, 6);
}

std::string ProgramDraw::to(char letter, double delta_u) {
  const std::string delta = length(delta_u, letter);
  if (modes_.incremental) return letter + delta;
  return fmt::format("{}[#{}+{}]", letter, 5420 + kLetters.find(letter), delta);
}

std::string ProgramDraw::spelled(char letter, double delta_u) {
  if (grbl() || !d_.chance(0.15)) return to(letter, delta_u);
  std::string factor = d_.chance(0.5) ? "SIN[" : "COS[";
  factor += w_.expression(1) + "]";
  const std::string delta = fmt::format("{}*{}", length(delta_u, letter), factor);
  if (modes_.incremental) return fmt::format("{}[{}]", letter, delta);
  return fmt::format("{}[#{}+{}]", letter, 5420 + kLetters.find(letter), delta);
}

/// F of a share of the machine's speed.
std::string ProgramDraw::feed(double share) { return "F" + length(m_.scale.speed_u_s * share * 60, 'X'); }

/// Turns at which a feed per turn is a share of the machine's speed.
double ProgramDraw::rpm(double share, double per_turn_u) const {
  return m_.scale.speed_u_s * share * 60 / per_turn_u;
}

void ProgramDraw::straight() {
  std::string text = d_.chance(0.65) ? "G1" : "G0";
  const bool tiny = d_.chance(0.08);
  for (const char letter : m_.letters)
    if (d_.chance(0.5)) text += " " + spelled(letter, tiny ? m_.scale.step_u * d_.real(-3, 3) : some_u());
  if (d_.chance(0.2)) text += " " + feed(d_.decades(0.02, 1.5));
  line(text);
}

/// A move that needs no plane and no mode: what loops and subroutines are made of.
void ProgramDraw::simple() {
  const char letter = d_.letter_of(m_.letters);
  const std::string code = d_.chance(0.8) ? "G1 " : "G0 ";
  line(code + to(letter, some_u() * 0.5));
}

void ProgramDraw::arc() {
  if (planes_.empty()) return;
  const Plane& p = modes_.plane;
  if (turned_ && p.code != "G17") return;
  const double radius = m_.scale.move_u * d_.decades(0.02, 1.5);
  const double from = d_.real(0, 2 * kPi), by = d_.real(0.2, 6);
  const SinCos begin = exact_sincos(from), end = exact_sincos(from + by);
  const double i = -radius * begin.cos, j = -radius * begin.sin;
  const double dx = i + radius * end.cos, dy = j + radius * end.sin;
  std::string text = d_.chance(0.5) ? "G2 " : "G3 ";
  text += to(p.first, dx) + " ";
  text += to(p.second, dy) + " ";
  if (d_.chance(0.4)) {
    const double least = std::sqrt(dx * dx + dy * dy) / 2;
    const double sign = d_.chance(0.5) ? 1 : -1;
    text += "R" + length(sign * (least * d_.real(1.01, 2) + 1e-5 * radius));
  } else {
    const char ij[] = {static_cast<char>('I' + p.first - 'X'), static_cast<char>('I' + p.second - 'X')};
    const auto number = [&](char letter, double value) {
      return modes_.absolute_centers
                 ? fmt::format("{}[#{}+{}] ", letter, 5420 + (letter - 'I'), length(value))
                 : fmt::format("{}{} ", letter, length(value));
    };
    text += number(ij[0], i) + number(ij[1], j);
    if (!grbl() && d_.chance(0.15)) text += fmt::format("P{} ", d_.whole(1, 3));
  }
  if (m_.has(p.normal) && d_.chance(0.4)) text += " " + to(p.normal, some_u() * 0.3);
  if (!m_.turning.empty() && d_.chance(0.2)) {
    const char letter = d_.letter_of(m_.turning);
    text += " " + to(letter, some_u());
  }
  if (d_.chance(0.2)) text += " " + feed(d_.decades(0.02, 1.5));
  line(text);
}

void ProgramDraw::circle() {
  if (planes_.empty() || modes_.absolute_centers || (turned_ && modes_.plane.code != "G17")) return;
  const double radius = m_.scale.move_u * d_.decades(0.02, 0.5);
  std::string text = d_.chance(0.5) ? "G2 " : "G3 ";
  text += static_cast<char>('I' + modes_.plane.first - 'X') + length(radius);
  if (d_.chance(0.4)) text += fmt::format(" P{}", d_.whole(1, 3));
  if (m_.has(modes_.plane.normal) && d_.chance(0.4)) text += " " + to(modes_.plane.normal, some_u() * 0.3);
  line(text);
}

/// Short lines: along one direction, around a corner, or anywhere.
void ProgramDraw::chain() {
  const int n = d_.whole(2, 25), kind = d_.whole(0, 2);
  const double size = m_.scale.move_u * d_.decades(0.005, 0.3);
  const char a = d_.letter_of(m_.letters), b = d_.letter_of(m_.letters);
  double heading = d_.real(0, 2 * kPi);
  for (int i = 0; i < n; ++i) {
    if (kind == 1) heading += d_.real(-0.3, 0.3);
    if (kind == 2) heading = d_.real(0, 2 * kPi);
    const SinCos direction = exact_sincos(heading);
    std::string text = i == 0 ? "G1 " : "";
    text += to(a, size * direction.cos);
    if (b != a) text += " " + to(b, size * direction.sin);
    line(text);
  }
}

void ProgramDraw::polar() {
  if (!has("XY") || turned_) return;
  line("G17");
  modes_.plane = planes_.front();
  const double radius = m_.scale.move_u * d_.real(0.2, 2);
  const std::string code = d_.chance(0.7) ? "G1 " : "G0 ";
  line(code + fmt::format("@{} ^{}", length(radius), plain(d_.real(-180, 180))));
  if (d_.chance(0.5) && !modes_.incremental) line(fmt::format("^{}", plain(d_.real(-90, 90))));
  if (d_.chance(0.3) && !modes_.incremental) line("@" + length(radius * 0.7));
}

void ProgramDraw::spline() {
  if (!has("XY")) return;
  line("G17");
  modes_.plane = planes_.front();
  const auto some = [&](char letter) { return letter + length(some_u()) + " "; };
  if (d_.chance(0.3)) {
    std::string text = "G5.1 " + some('I');
    text += some('J');
    text += to('X', some_u()) + " ";
    line(text + to('Y', some_u()));
    return;
  }
  const int n = d_.whole(1, 3);
  for (int i = 0; i < n; ++i) {
    std::string text = "G5 ";
    if (i == 0 || d_.chance(0.5)) {
      text += some('I');
      text += some('J');
    }
    text += some('P');
    text += some('Q');
    text += to('X', some_u()) + " ";
    line(text + to('Y', some_u()));
  }
}

void ProgramDraw::nurbs() {
  if (!has("XY")) return;
  line("G17 G90 #101=#5420 #102=#5421");
  modes_.plane = planes_.front();
  const int order = d_.chance(0.8) ? d_.whole(3, 5) : d_.whole(6, 12);
  const auto point = [&] {
    std::string text = fmt::format("X[#101+{}] ", length(some_u()));
    return text + fmt::format("Y[#102+{}] ", length(some_u()));
  };
  std::string head = fmt::format("G5.2 P{} L{} ", plain(d_.real(0.5, 2), 3), order);
  if (d_.chance(0.5)) head += point();
  line(head);
  for (int n = order + d_.whole(0, 3); n > 0; --n) {
    const std::string words = point();
    line(words + "P" + plain(d_.real(0.3, 3), 3));
  }
  line("G5.3");
  if (modes_.incremental) line("G91");
}

/// A closed way around a polygon, compensated on its outside or inside.
void ProgramDraw::contour() {
  if (!has("XY")) return;
  const double side = m_.scale.move_u * d_.real(0.3, 1);
  const double radius = side * d_.decades(0.01, 0.12);
  const int corners = d_.whole(3, 6);
  const double turn = (d_.chance(0.5) ? 1 : -1) * 2 * kPi / corners;
  const bool left = d_.chance(0.5), by_table = tools_given_ && d_.chance(0.3);
  line("G17 G40");
  modes_.plane = planes_.front();
  double heading = d_.real(0, 2 * kPi);
  line(by_table ? fmt::format("{} D9", left ? "G41" : "G42")
                : fmt::format("{} D{}", left ? "G41.1" : "G42.1", length(2 * radius)));
  const bool was_incremental = modes_.incremental;
  if (!was_incremental) line("G91");
  modes_.incremental = true;
  for (int i = 0; i <= corners; ++i) {
    const SinCos direction = exact_sincos(heading);
    std::string text = i == 0 ? "G1 " : "";
    text += to('X', side * direction.cos) + " ";
    text += to('Y', side * direction.sin);
    if (i > 0 && m_.has('Z') && d_.chance(0.1)) text += " " + to('Z', side * 0.1);
    line(text);
    if (i > 0 && d_.chance(0.1))
      line(d_.pick<std::string>({"M8", "S300", "G4 P0.001", "(MSG, on the contour)"}));
    heading += i == 0 ? 0 : turn;
  }
  line("G40");
  const SinCos away = exact_sincos(heading);
  std::string text = "G1 " + to('X', side * away.cos) + " ";
  line(text + to('Y', side * away.sin));
  modes_.incremental = was_incremental;
  if (!was_incremental) line("G90");
}

void ProgramDraw::thread() {
  if (!m_.has('Z')) return;
  const double pitch = m_.scale.move_u * d_.decades(0.05, 1);
  line("M3 S" + plain(rpm(d_.decades(0.05, 0.6), pitch)));
  double depth = m_.scale.move_u * d_.real(0.3, 1.5);
  if (d_.chance(0.7)) depth = -depth;
  std::string text = d_.chance(0.6) ? "G33 " : "G33.1 ";
  text += to('Z', depth) + " ";
  if (text[3] == ' ' && m_.has('X') && d_.chance(0.3)) text += to('X', 0.2 * some_u()) + " ";
  line(text + "K" + length(pitch));
}

void ProgramDraw::thread_cycle() {
  if (!has("XZ")) return;
  const double pitch = m_.scale.move_u * d_.decades(0.05, 0.5);
  const double first = 0.02 * m_.scale.move_u * d_.real(0.5, 2);
  line("G18");
  for (const Plane& plane : planes_)
    if (plane.code == "G18") modes_.plane = plane;
  line("M3 S" + plain(rpm(d_.decades(0.05, 0.4), pitch)));
  std::string text = "G76 P" + length(pitch) + " ";
  text += to('Z', -m_.scale.move_u * d_.real(0.3, 1)) + " ";
  text += fmt::format("I{} ", length(-first * d_.real(1, 4)));
  text += fmt::format("J{} ", length(first));
  text += "K" + length(first * d_.real(1.1, 2.5));
  if (d_.chance(0.4)) text += " R" + plain(d_.real(1, 2), 2);
  if (d_.chance(0.4)) text += " Q" + plain(d_.real(0, 30), 3);
  if (d_.chance(0.3)) text += fmt::format(" H{}", d_.whole(0, 2));
  if (d_.chance(0.3)) {
    text += " E" + length(first);
    text += fmt::format(" L{}", d_.whole(0, 3));
  }
  line(text);
}

void ProgramDraw::cycle() {
  if (planes_.empty()) return;
  const Plane& p = modes_.plane;
  if (!m_.has(p.normal) || (turned_ && p.code != "G17")) return;
  const std::string code = d_.pick<std::string>({"G81", "G82", "G83", "G73", "G85", "G86", "G89"});
  if (code == "G86") line("M3 S800");
  const double depth = m_.scale.move_u * d_.real(0.3, 1), above = m_.scale.move_u * d_.real(0.02, 0.3);
  std::string text = d_.pick<std::string>({"G98 ", "G99 ", ""}) + code + " ";
  text += to(p.first, some_u()) + " ";
  text += to(p.second, some_u()) + " ";
  text += modes_.incremental ? fmt::format("{}{} ", p.normal, length(-depth)) : to(p.normal, -depth) + " ";
  text += modes_.incremental ? "R" + length(above)
                             : fmt::format("R[#{}+{}]", 5420 + kLetters.find(p.normal), length(above));
  if (code == "G82" || code == "G86" || code == "G89") text += " P" + plain(m_.scale.tau_s * d_.whole(0, 20));
  if (code == "G83" || code == "G73") text += " Q" + length((depth + above) * d_.real(0.2, 1.2));
  if (d_.chance(0.25)) text += fmt::format(" L{}", d_.whole(1, 3));
  line(text);
  if (d_.chance(0.4)) line(to(p.first, some_u() * 0.4));
  line(d_.chance(0.5) ? "G80" : "G0");
}

void ProgramDraw::tapping() {
  if (!has("XYZ") || modes_.plane.code != "G17") return;
  const bool right = d_.chance(0.5);
  line(fmt::format("{} S{}", right ? "M3" : "M4", d_.whole(50, 2000)));
  std::string text = right ? "G84 " : "G74 ";
  text += to('X', some_u() * 0.3) + " ";
  const double depth = m_.scale.move_u * d_.real(0.2, 0.7);
  text += modes_.incremental ? "Z" + length(-depth) : to('Z', -depth);
  text += modes_.incremental ? " R" + length(depth * 0.1) : fmt::format(" R[#5422+{}]", length(depth * 0.1));
  line(text + " P" + plain(m_.scale.tau_s * d_.whole(0, 5)));
  line("G80");
}

void ProgramDraw::probe() {
  if (linear_.empty()) return;
  const char letter = m_.has('Z') ? 'Z' : linear_.front();
  const std::string code = d_.pick<std::string>({"G38.2", "G38.3", "G38.4", "G38.5"});
  line(code + " " + to(letter, -m_.scale.move_u * d_.real(0.5, 2)));
  if (d_.chance(0.3)) line("#1=[#5063+#5070]");
}

void ProgramDraw::inverse_time() {
  line("G93");
  for (int n = d_.whole(1, 3); n > 0; --n) {
    const char letter = d_.letter_of(m_.letters);
    const std::string words = to(letter, some_u() * 0.5);
    // a move lasts 20 to 200 control ticks
    line("G1 " + words + " F" + plain(60 / (m_.scale.tau_s * d_.decades(20, 200))));
  }
  const std::string back = feed(d_.decades(0.1, 1));
  line("G94 " + back);
}

void ProgramDraw::per_turn() {
  const double per_turn = m_.scale.move_u * d_.decades(0.01, 0.3);
  line("M3 S" + plain(rpm(d_.decades(0.1, 1), per_turn)));
  line("G95 F" + length(per_turn));
  simple();
  if (d_.chance(0.5)) simple();
  const std::string back = feed(d_.decades(0.1, 1));
  line("G94 " + back);
  if (d_.chance(0.3) && m_.has('X') && !m_.rotary('X')) {
    line("G96 S" + plain(d_.real(20, 200)) + " D1500");
    simple();
    line("G97 S300");
  }
}

}  // namespace kadr::storm
