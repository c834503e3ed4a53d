#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gcode/arc.h"
#include "machine/base/numbers.h"
#include "planner/path/path.h"
#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

constexpr double kExact_mm = 1e-9;

/// Ends of the moves in the plane XY, and the centre of an arc: "L x y" "R x y" (rapid) "A x y about x y".
std::vector<std::string> outline(const std::string& program, const InterpretOptions& options = {}) {
  std::vector<std::string> lines;
  for (const LineOrArc& b : run(program, options).moves()) {
    // + 0.0: no negative zero
    const auto at = [](double v) { return std::round(v * 1e4) / 1e4 + 0.0; };
    std::string line = fmt::format("{} {} {}",
                                   b.kind == BlockKind::traverse ? 'R'
                                   : b.kind == BlockKind::feed   ? 'L'
                                   : b.turns > 0                 ? 'A'
                                                                 : 'C',
                                   at(b.end[0]), at(b.end[1]));
    if (b.kind == BlockKind::arc) {
      line += fmt::format(" about {} {}", at(b.center_first_mm), at(b.center_second_mm));
    }
    lines.push_back(line);
  }
  return lines;
}
using Lines = std::vector<std::string>;

/// The contour or its path seen in the mirror: Y and J change sign, left is right, clockwise is counter-clockwise.
std::string mirrored(const std::string& text, std::string_view across) {
  std::string other;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool code = i > 0 && text[i - 1] == 'G';
    other += c == 'A' ? 'C' : c == 'C' ? 'A' : code && c == '2' ? '3' : code && c == '3' ? '2' : c;
    if (across.find(c) == std::string_view::npos) continue;
    if (text[i + 1] == '-') {
      ++i;
    } else if (text[i + 1] != '0') {
      other += '-';
    }
  }
  return other;
}

/// The compensated path along a contour with a tool of 4 mm left of it, and right of it in the mirror.
/// @param path  without the move to the start and the one away from the contour
void check_corner(const std::string& start, const std::string& contour, const Lines& path) {
  CAPTURE(contour);
  const auto compensated = [](const std::string& from, const char* code, const std::string& moves) {
    Lines lines = outline(fmt::format("G21 F100\nG0 {}\n{} D4\n{}\nG40\nG0 Y200\nM2\n", from, code, moves));
    REQUIRE(lines.size() > 2);
    return Lines(lines.begin() + 1, lines.end() - 1);
  };
  CHECK(compensated(start, "G41.1", contour) == path);
  Lines other;
  for (const std::string& line : path) {
    std::string marked = line;
    // "L x y", "A x y about x y": every second number
    std::size_t numbers = 0;
    for (std::size_t i = 1; i < marked.size(); ++i) {
      if (marked[i] == ' ' && marked[i + 1] != 'a' && ++numbers % 2 == 0) marked[i] = '|';
    }
    marked = mirrored(marked, "|");
    std::replace(marked.begin(), marked.end(), '|', ' ');
    other.push_back(marked);
  }
  CHECK(compensated(mirrored(start, "Y"), "G42.1", mirrored(contour, "YJ")) == other);
}

/// A piece of a path in the plane XY.
struct Piece {
  PlanePoint start, end, center;
  int turns = 0;  ///< 0: a line
};

double apart(PlanePoint a, PlanePoint b) {
  return std::hypot(a.first_mm - b.first_mm, a.second_mm - b.second_mm);
}

PlanePoint point_of(const Piece& piece, double part) {
  const PlanePoint a = piece.start, b = piece.end, c = piece.center;
  if (piece.turns == 0) {
    return {a.first_mm + part * (b.first_mm - a.first_mm), a.second_mm + part * (b.second_mm - a.second_mm)};
  }
  const double sweep = arc_sweep_rad(a, b, c, piece.turns < 0, 1) * (piece.turns < 0 ? -1 : 1) * part;
  const double x = a.first_mm - c.first_mm, y = a.second_mm - c.second_mm;
  return {c.first_mm + x * std::cos(sweep) - y * std::sin(sweep),
          c.second_mm + x * std::sin(sweep) + y * std::cos(sweep)};
}

double distance(PlanePoint p, const Piece& piece) {
  const PlanePoint a = piece.start, b = piece.end;
  const double ends = std::min(apart(p, a), apart(p, b));
  if (piece.turns != 0) {
    const bool clockwise = piece.turns < 0;
    const double whole = arc_sweep_rad(a, b, piece.center, clockwise, 1);
    if (arc_sweep_rad(a, p, piece.center, clockwise, 1) > whole) return ends;
    return std::fabs(apart(p, piece.center) - apart(a, piece.center));
  }
  const double x = b.first_mm - a.first_mm, y = b.second_mm - a.second_mm;
  const double along = ((p.first_mm - a.first_mm) * x + (p.second_mm - a.second_mm) * y) / (x * x + y * y);
  return along <= 0 || along >= 1 ? ends : apart(p, point_of(piece, along));
}

std::vector<Piece> pieces(const std::vector<LineOrArc>& moves) {
  std::vector<Piece> out;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    Piece piece;
    piece.start = {moves[i - 1].end[0], moves[i - 1].end[1]};
    piece.end = {moves[i].end[0], moves[i].end[1]};
    if (moves[i].kind == BlockKind::arc) {
      piece.center = {moves[i].center_first_mm, moves[i].center_second_mm};
      piece.turns = moves[i].turns;
    }
    out.push_back(piece);
  }
  return out;
}

/// A contour that runs from left to right, its direction within 50 degrees of X: corners to either side and
/// tangent arcs, each move long enough for the tool not to touch the next but one.
std::vector<Piece> wavy_contour(Random& random, double radius_mm) {
  std::vector<Piece> contour;
  PlanePoint at{0, 0};
  double heading = random.real(-0.8, 0.8);
  for (int i = 0; i < 9; ++i) {
    Piece piece;
    piece.start = at;
    if (i > 0 && i < 8 && random.chance(0.4)) {
      const double next = random.real(-0.8, 0.8);
      if (std::fabs(next - heading) < 0.1) continue;
      piece.turns = next > heading ? 1 : -1;
      const double arc_radius = radius_mm * 6 / std::fabs(next - heading);
      const double across = heading + piece.turns * kPi / 2;
      piece.center = {at.first_mm + arc_radius * std::cos(across),
                      at.second_mm + arc_radius * std::sin(across)};
      const double back = next - piece.turns * kPi / 2;
      piece.end = {piece.center.first_mm + arc_radius * std::cos(back),
                   piece.center.second_mm + arc_radius * std::sin(back)};
      heading = next;
    } else {
      // flatter corners are left as they are
      double next = heading;
      while (std::fabs(next - heading) < 0.06) next = random.real(-0.8, 0.8);
      if (i > 0) heading = next;
      const double size = radius_mm * random.real(6, 15);
      piece.end = {at.first_mm + size * std::cos(heading), at.second_mm + size * std::sin(heading)};
    }
    at = piece.end;
    contour.push_back(piece);
  }
  return contour;
}

std::string contour_text(const std::vector<Piece>& contour) {
  std::string text;
  for (const Piece& piece : contour) {
    text += fmt::format("{} X{:.15f} Y{:.15f}",
                        piece.turns == 0  ? "G1"
                        : piece.turns > 0 ? "G3"
                                          : "G2",
                        piece.end.first_mm, piece.end.second_mm);
    if (piece.turns != 0) {
      text += fmt::format(" I{:.15f} J{:.15f}", piece.center.first_mm - piece.start.first_mm,
                          piece.center.second_mm - piece.start.second_mm);
    }
    text += "\n";
  }
  return text;
}

std::vector<Piece> reversed(const std::vector<Piece>& contour) {
  std::vector<Piece> back;
  for (auto piece = contour.rbegin(); piece != contour.rend(); ++piece) {
    back.push_back({piece->end, piece->start, piece->center, -piece->turns});
  }
  return back;
}

std::string start_at(PlanePoint p) {
  return fmt::format("G21 G90 G17 F500\nG0 X{:.15f} Y{:.15f}\n", p.first_mm, p.second_mm);
}

}  // namespace

TEST_CASE("outside a square the tool goes round each corner") {
  // tool of 6 mm left of a square of 20 mm run clockwise: 3 mm outside it. The entry along X leads to 3 mm
  // left of X0 Y0, where an inside corner follows: X-3 is the left edge's offset.
  CHECK(outline("G21 F100\nG0 X-10 Y0\nG41.1 D6\nG1 X0 Y0\nY20\nX20\nY0\nX-10\nG40\nG0 Y-10\nM2\n") ==
        Lines{"R -10 0", "L -3 3", "L -3 20", "C 0 23 about 0 20", "L 20 23", "C 23 20 about 20 20", "L 23 0",
              "C 20 -3 about 20 0", "L -10 -3", "R -10 -10"});
}

TEST_CASE("inside a square each move ends where the tool touches the next one") {
  // tool of 6 mm left of a square run counter-clockwise: 3 mm inside it, 20 - 2·3 = 14 mm long. The entry
  // stands to the left of its own direction first, at X7.
  CHECK(outline("G21 F100\nG0 X10 Y-10\nG41.1 D6\nG1 X10 Y0\nX20\nY20\nX0\nY0\nX10\nG40\nG0 Y10\nM2\n") ==
        Lines{"R 10 -10", "L 7 0", "C 10 3 about 10 0", "L 17 3", "L 17 17", "L 3 17", "L 3 3", "L 10 3",
              "R 10 10"});
}

TEST_CASE("an arc is run on a radius larger or smaller by the tool's") {
  // tool of 4 mm; the arc of 10 mm about X10 Y10 is met and left tangentially
  const std::string contour = "G1 X0 Y0\nX10\nG3 X20 Y10 J10\nG1 Y20\nG40\nG0 X50 Y50\nM2\n";
  CHECK(outline("G21 F100\nG0 X-9 Y0\nG41.1 D4\n" + contour) ==
        Lines{"R -9 0", "L 0 2", "L 10 2", "A 18 10 about 10 10", "L 18 20", "R 50 50"});
  CHECK(outline("G21 F100\nG0 X-9 Y0\nG42.1 D4\n" + contour) ==
        Lines{"R -9 0", "L 0 -2", "L 10 -2", "A 22 10 about 10 10", "L 22 20", "R 50 50"});
}

TEST_CASE("an entry arc begins at the bare point and ends beside the contour in its direction") {
  // to X10 Y10 about X0 Y10, upwards there; the tool of 4 mm ends at X8. The new centre lies on Y10, as far
  // from X8 as from X0 Y0: (8 - c)^2 = c^2 + 10^2, c = -36/16 = -2.25.
  CHECK(outline("G21 F100\nG41.1 D4\nG3 X10 Y10 J10\nG1 Y20\nG40\nG0 X50\nM2\n") ==
        Lines{"A 8 10 about -2.25 10", "L 8 20", "R 50 20"});
}

TEST_CASE("at an inside corner moves end where their offsets cross") {
  // tool of 4 mm left of the contour: offsets lie 2 mm to the left, circles have a radius of 8 mm where the
  // tool runs inside the arc of 10 mm, and of 12 mm where it runs outside.
  // Line and line, 120 degrees to the left: 2·tan(60) before the corner.
  check_corner("X-20 Y0", "G1 X0\nX20\nX10 Y17.32050808", {"L 0 2", "L 16.5359 2", "L 8.2679 16.3205"});
  // Line and arc inside: y = 2 on the circle of 8 about X10: 10 + sqrt(64 - 4)
  check_corner("X-20 Y0", "G1 X0\nX20\nG3 X10 Y10 I-10", {"L 0 2", "L 17.746 2", "A 10 8 about 10 0"});
  // Line and arc outside: y = 2 on the circle of 12 about X30: 30 - sqrt(144 - 4)
  check_corner("X-20 Y0", "G1 X0\nX20\nG2 X30 Y10 I10", {"L 0 2", "L 18.1678 2", "C 30 12 about 30 0"});
  // Arc inside and line: y = -2 on the circle of 8 about X10
  check_corner("X-20 Y-10", "G1 X10\nG3 X20 Y0 J10\nG1 X0", {"L 10 -8", "A 17.746 -2 about 10 0", "L 0 -2"});
  // Arc outside and line: y = 2 on the circle of 12: sqrt(144 - 4)
  check_corner("X-20 Y10", "G1 X0\nG2 X10 Y0 J-10\nG1 X30", {"L 0 12", "C 11.8322 2 about 0 0", "L 30 2"});
  // Two arcs about X-6 and X6 that meet at X0 Y8. Inside both: sqrt(64 - 36); outside both: sqrt(144 - 36)
  check_corner("X-16 Y-20", "G1 X0 Y-8\nG3 Y8 I-6 J8\nG3 Y-8 I6 J-8",
               {"L -1.2 -6.4", "A 0 5.2915 about -6 0", "A 1.2 -6.4 about 6 0"});
  check_corner("X-16 Y-20", "G1 Y0\nG2 X0 Y8 I10\nG2 X16 Y0 I6 J-8",
               {"L -18 0", "C 0 10.3923 about -6 0", "C 18 0 about 6 0"});
  // Inside the first, outside the second about X-8 Y14: of sqrt(200) between the centres,
  // (64 + 200 - 144)/(2·sqrt(200)) = 3·sqrt(2) lie before the foot of the crossing, sqrt(64 - 18) across.
  // X -6 - 0.6 + 0.98995·6.78233, Y 4.2 + 0.14142·6.78233
  check_corner("X-16 Y-20", "G1 X0 Y-8\nG3 Y8 I-6 J8\nG2 X-8 Y4 I-8 J6",
               {"L -1.2 -6.4", "A 0.1142 5.1592 about -6 0", "C -8 2 about -8 14"});
}

TEST_CASE("at an outside corner an arc about it joins the offsets of lines and arcs") {
  // tool of 4 mm; it stands 2 mm off the end of one move and goes round to 2 mm off the beginning of the next
  check_corner("X-20 Y0", "G1 X0\nX20\nX30 Y-17.32050808",
               {"L 0 2", "L 20 2", "C 21.7321 1 about 20 0", "L 31.7321 -16.3205"});
  check_corner("X-20 Y0", "G1 X0\nX20\nG2 X10 Y-10 I-10",
               {"L 0 2", "L 20 2", "C 22 0 about 20 0", "C 10 -12 about 10 0"});
  check_corner("X-20 Y0", "G1 X0\nX20\nG3 X30 Y-10 I10",
               {"L 0 2", "L 20 2", "C 22 0 about 20 0", "A 30 -8 about 30 0"});
  check_corner("X-20 Y0", "G1 X10\nG3 X20 Y10 J10\nG1 X40",
               {"L 10 2", "A 18 10 about 10 10", "C 20 12 about 20 10", "L 40 12"});
  check_corner("X-20 Y10", "G1 X0\nG2 X10 Y0 J-10\nG1 X-10",
               {"L 0 12", "C 12 0 about 0 0", "C 10 -2 about 10 0", "L -10 -2"});
  // two arcs about X6 and X-6 that meet at X0 Y8
  check_corner("X16 Y-20", "G1 X0 Y-8\nG2 Y8 I6 J8\nG2 Y-8 I-6 J-8",
               {"L -1.2 -9.6", "C -1.2 9.6 about 6 0", "C 1.2 9.6 about 0 8", "C 1.2 -9.6 about -6 0"});
}

TEST_CASE("moves without motion in the plane wait with the move before them") {
  // down and up again in an inside corner: all stand where the trimmed move ends
  const Outcome outcome =
      run("G21 F100\nG0 X-20 Y0\nG41.1 D4\nG1 X0 Y0\nX20\nZ-5\nG0 Z1\nG1 Y20\nG40\nG0 X0\nM2\n");
  const std::vector<LineOrArc> moves = outcome.moves();
  REQUIRE(moves.size() == 7);
  CHECK(moves[2].end == AxisValues{18, 2, 0});
  CHECK(moves[3].end == AxisValues{18, 2, -5});
  CHECK(moves[3].length_u == 5);
  CHECK(moves[4].end == AxisValues{18, 2, 1});
  CHECK(moves[4].kind == BlockKind::traverse);
  CHECK(moves[5].end == AxisValues{18, 20, 1});
}

TEST_CASE("around a corner the rapid move goes straight, Z waits and rotary axes turn") {
  const Outcome outcome =
      run("G21 F100\nG0 X-20 Y0\nG41.1 D4\nG1 X0 Y0\nX20\nG0 Y-20 Z5 A90\nG40\nG0 X0\nM2\n");
  const std::vector<LineOrArc> moves = outcome.moves();
  REQUIRE(moves.size() == 6);
  CHECK(moves[3].kind == BlockKind::traverse);
  CHECK(moves[3].end == AxisValues{22, 0, 0, 90});
  CHECK(moves[4].end == AxisValues{22, -20, 5, 90});
}

TEST_CASE("what is called for between two moves stays between them, messages come at once") {
  const Outcome outcome =
      run("G21 F100\nG0 X-20\nG41.1 D4\nG1 X0\nX20\nF50\nM3 S100\n(MSG,now)\nG4 P1\nM8\nY20\nG40\nM5\nG0 "
          "X0\nM2\n");
  std::vector<std::string> names;
  for (const std::string& line : outcome.trace) names.push_back(line.substr(0, line.find(' ')));
  const auto begin = std::find(names.begin(), names.end(), "MESSAGE");
  REQUIRE(begin != names.end());
  CHECK(std::vector<std::string>(begin, begin + 9) ==
        std::vector<std::string>{"MESSAGE", "STRAIGHT_FEED", "SET_FEED_RATE", "SET_SPINDLE_SPEED",
                                 "START_SPINDLE_CLOCKWISE", "DWELL", "FLOOD_ON", "STRAIGHT_FEED",
                                 "STOP_SPINDLE_TURNING"});
}

TEST_CASE("a program stop ends the waiting move at its full length") {
  CHECK(outline("G21 F100\nG0 X-20\nG41.1 D4\nG1 X0\nX20\nM0\nY20\nG40\nG0 X0\nM2\n") ==
        Lines{"R -20 0", "L 0 2", "L 20 2", "L 18 20", "R 0 20"});
  // so do M2 and the end of the file
  CHECK(outline("G21 F100\nG0 X-20\nG41.1 D4\nG1 X0\nX20\nM2\n").back() == "L 20 2");
  CHECK(outline("G21 F100\nG0 X-20\nG41.1 D4\nG1 X0\nX20\n").back() == "L 20 2");
}

TEST_CASE("inverse time holds for the programmed length: a longer path takes longer") {
  // 20 mm in 60/2 = 30 s: 2/3 mm/s. About the corner the tool of 4 mm adds an arc of pi/2 · 2 mm; the entry
  // of 20 mm is sqrt(20² + 2²) mm long.
  const std::vector<LineOrArc> moves =
      run("G21 G93\nG0 X-20\nG41.1 D4\nG1 X0 F2\nX20 F2\nY-20 F2\nG40\nG0 X0\nM2\n").moves();
  REQUIRE(moves.size() == 6);
  const double feed = 20.0 / 30.0;
  const double lengths[] = {std::sqrt(404.0), 20, kPi, 20};
  for (std::size_t i = 0; i < 4; ++i) {
    CAPTURE(i);
    CHECK(moves[i + 1].length_u == doctest::Approx(lengths[i]).epsilon(1e-12));
    CHECK(moves[i + 1].feed_u_s == doctest::Approx(feed).epsilon(1e-12));
    CHECK(moves[i + 1].duration_s == doctest::Approx(lengths[i] / feed).epsilon(1e-12));
  }
}

TEST_CASE("the first move after G40 is as long as the way back to the contour makes it") {
  // half an inch off X2: a move that names A only moves the tool by that, at F1 in inches
  const std::vector<LineOrArc> moves =
      run("G20\nF1\nG0 X-1\nG41.1 D1\nG1 X0\nX2\nG40\nG1 A90\nG1 A0\nM2\n").moves();
  REQUIRE(moves.size() == 5);
  CHECK(moves[3].feed_length == FeedLength::xyz);
  CHECK(moves[3].length_u == doctest::Approx(12.7));
  CHECK(moves[3].feed_u_s == doctest::Approx(25.4 / 60));
  CHECK(moves[4].feed_length == FeedLength::rotary);
  CHECK(moves[4].feed_u_s == doctest::Approx(1.0 / 60));
}

TEST_CASE("parameters 5420 and 5421 read the tool's centre, incremental moves start at the contour") {
  const Outcome outcome =
      run("G21 F100\nG0 X-20\nG41.1 D4\nG1 X0\n(DEBUG,#5420 #5421)\nG91 X20 Y0\nY-20\n(DEBUG,#5420 "
          "#5421)\nG40\n(DEBUG,#5420 #5421)\nG0 X0\nM2\n");
  std::vector<std::string> messages;
  for (const Message& m : outcome.all<Message>()) messages.push_back(m.text);
  CHECK(messages == Lines{"0.000000 2.000000", "22.000000 -20.000000", "20.000000 -20.000000"});
  CHECK(outcome.moves().back().end == AxisValues{20, -20});
}

TEST_CASE("tool radius and orientation come from the table, of the tool in the spindle without D") {
  InterpretOptions options;
  Tool mill, smaller, lathe;
  mill.number = 1;
  mill.diameter_mm = 6;
  smaller.number = 2;
  smaller.diameter_mm = -4;
  lathe.number = 3;
  lathe.diameter_mm = 2;
  lathe.orientation = 2;
  options.tools = ToolTable{{mill, smaller, lathe}};
  CHECK(outline("G21 F100 T1 M6\nG41\nG1 X20\nG40\nG0 Y0\nM2\n", options)[0] == "L 20 3");
  CHECK(outline("G21 F100 T1 M6\nG42 D0\nG1 X20\nG40\nG0 Y0\nM2\n", options)[0] == "L 20 -3");
  // a negative diameter is the other side
  CHECK(outline("G21 F100\nG41 D2\nG1 X20\nG40\nG0 Y0\nM2\n", options)[0] == "L 20 -2");
  // orientation 2: the controlled point lies at the nose's centre less the radius in X and Z. Along Z to 20,
  // left of it is +X: 1 mm off, and 1 mm back.
  const std::vector<LineOrArc> moves = run("G21 G18 F100\nG41 D3\nG1 Z20\nG40\nG0 X9\nM2\n", options).moves();
  REQUIRE(moves.size() == 2);
  CHECK(moves[0].end == AxisValues{0, 0, 19});
  CHECK(moves[1].end == AxisValues{9, 0, 20});
}

TEST_CASE("in G18 the plane of compensation turns with the work system") {
  // turned by 90 degrees the program's X is the machine's Y: left of the way along Z is Y2, and a move along
  // X continues along Y
  const std::vector<LineOrArc> moves =
      run("G21 G18 F100\nG10 L2 P1 R90\nG41.1 D4\nG1 Z20\nG1 Y-3\nG2 Z22 X-2 K0 I-2\nG40\nG0 X9\nM2\n")
          .moves();
  REQUIRE(moves.size() == 4);
  const auto at = [](const LineOrArc& b, double x, double y, double z) {
    return std::fabs(b.end[0] - x) < kExact_mm && std::fabs(b.end[1] - y) < kExact_mm &&
           std::fabs(b.end[2] - z) < kExact_mm;
  };
  CHECK(at(moves[0], 0, 2, 20));
  CHECK(at(moves[1], 3, 2, 20));
  // clockwise about program X-2 Z20, tool outside: 4 mm off the centre
  CHECK(at(moves[2], 3, -2, 24));
  CHECK(moves[2].plane_rotation_deg == 90);
  CHECK(moves[2].length_u == doctest::Approx(kPi / 2 * 4).epsilon(1e-12));
  CHECK(at(moves[3], 3, 9, 22));
}

TEST_CASE("at a tool change behind G40 the program goes on where the tool stands") {
  const std::string head = "G21 F100\nG41.1 D4\nG1 X20\nG40\n";
  CHECK(outline(head + "G91 G0 X5\nM2\n") == Lines{"L 20 2", "R 25 0"});
  CHECK(outline(head + "T1 M6\nG91 G0 X5\nM2\n") == Lines{"L 20 2", "R 25 2"});
}

TEST_CASE("an arc behind a nearly straight corner may sweep a little more than programmed") {
  // atan(0.8/20) = 0.03998 rad before the arc, the tool of 2 mm inside: the sweep grows by
  // 0.08/(r - 2) rad, allowed are 0.0254 under G21 and 0.001 under G20
  const auto told = [](const char* units, const char* radius) {
    return run(fmt::format(
                   "{0}\nF100\nG0 X-20 Y-0.8\nG41.1 D4\nG1 X0 Y0\nG3 X{1} Y{1} J{1}\nG40\nG0 X90\nM2\n",
                   units, radius))
        .codes();
  };
  CHECK(told("G21", "5.15").empty());
  CHECK(told("G21", "5.12") == std::vector<Code>{Code::compensation_gouge});
  CHECK(told("G20", "83").empty());
  CHECK(told("G20", "80") == std::vector<Code>{Code::compensation_gouge});
}

TEST_CASE("after another mistake in a contour its corners are not judged") {
  // without the misread line the corner at X40 would be refused
  const std::string corner = "G21 F100\nG0 X-20\nG41.1 D6\nG1 X0\nX40\n{}Y4\nX0\nG40\nG0 Y30\nM2\n";
  CHECK(run(fmt::format(fmt::runtime(corner), "")).codes() == std::vector<Code>{Code::compensation_gouge});
  CHECK(run(fmt::format(fmt::runtime(corner), "X1,5\n")).codes() == std::vector<Code>{Code::decimal_comma});
}

TEST_CASE("every corner that the tool does not fit into is told") {
  const Outcome outcome =
      run("G21 F100\nG0 X-20\nG41.1 D6\nG1 X0\nX40\nY4\nX0\nY40\nX90\nY42\nX0\nG40\nG0 X0 Y90\nM2\n");
  // between lines 3 mm inside, Y4 would be 4 - 2·3 = -2 mm long, and Y42 2 - 2·3 = -4 mm
  CHECK(outcome.codes() == std::vector<Code>(2, Code::compensation_gouge));
  std::vector<std::uint32_t> lines;
  for (const Diagnostic& d : outcome.diagnostics.list()) lines.push_back(d.span.line);
  CHECK(lines == std::vector<std::uint32_t>{7, 11});
}

TEST_CASE("the tool's centre stays one radius beside a random contour, length and feed fit the path") {
  for (std::uint64_t i = 0; i < count(300); ++i) {
    Random random(seed() * 7919 + i);
    const double radius = random.real(0.2, 5);
    const std::vector<Piece> contour = wavy_contour(random, radius);
    const bool left = random.chance(0.5);
    const Outcome outcome =
        run(start_at(contour[0].start) + fmt::format("{} D{:.15f}\n", left ? "G41.1" : "G42.1", 2 * radius) +
            contour_text(contour) + "G40\nG0 Y900\nM2\n");
    CAPTURE(seed() * 7919 + i);
    REQUIRE(outcome.rendered == "");
    const std::vector<LineOrArc> moves = outcome.moves();
    const std::vector<Piece> path = pieces(moves);
    double worst = 0;
    // the first piece leads from the bare point to the contour, the last one away
    for (std::size_t k = 1; k + 1 < path.size(); ++k) {
      for (double part = 0; part <= 1; part += 0.125) {
        const PlanePoint p = point_of(path[k], part);
        double near = 1e9;
        for (const Piece& piece : contour) near = std::min(near, distance(p, piece));
        worst = std::max(worst, std::fabs(near - radius));
      }
      const double length = path[k].turns == 0 ? apart(path[k].start, path[k].end)
                                               : arc_sweep_rad(path[k].start, path[k].end, path[k].center,
                                                               path[k].turns < 0, 1) *
                                                     apart(path[k].start, path[k].center);
      CHECK(moves[k + 1].length_u == doctest::Approx(length).epsilon(1e-9));
      CHECK(moves[k + 1].feed_u_s == doctest::Approx(500.0 / 60));
    }
    CHECK(worst < kExact_mm);
  }
}

TEST_CASE("left of a contour and right of the same contour run backwards are one path") {
  for (std::uint64_t i = 0; i < count(300); ++i) {
    Random random(seed() * 104729 + i);
    const double radius = random.real(0.2, 5);
    const std::vector<Piece> contour = wavy_contour(random, radius);
    const auto compensated = [&](const std::vector<Piece>& way, const char* code) {
      const Outcome outcome = run(start_at(way[0].start) + fmt::format("{} D{:.15f}\n", code, 2 * radius) +
                                  contour_text(way) + "G40\nG0 Y900\nM2\n");
      REQUIRE(outcome.rendered == "");
      std::vector<Piece> path = pieces(outcome.moves());
      // between the first corner and the last
      path.pop_back();
      path.erase(path.begin());
      path.pop_back();
      return path;
    };
    const std::vector<Piece> there = compensated(contour, "G41.1");
    const std::vector<Piece> back = reversed(compensated(reversed(contour), "G42.1"));
    CAPTURE(seed() * 104729 + i);
    REQUIRE(there.size() == back.size());
    for (std::size_t k = 0; k < there.size(); ++k) {
      CHECK(there[k].turns == back[k].turns);
      CHECK(apart(there[k].start, back[k].start) < kExact_mm);
      CHECK(apart(there[k].end, back[k].end) < kExact_mm);
      CHECK(apart(there[k].center, back[k].center) < kExact_mm);
    }
  }
}

TEST_CASE("the present point can't be computed with while compensation is on, and can be shown") {
  const std::string contour = "G21 F100\nG0 X-20\nG41.1 D4\nG1 X0\n";
  CHECK(only_code(contour + "X[#5420+5]\nG40\nG0 Y9\nM2\n") == Code::compensation_conflict);
  CHECK(only_code(contour + "X5\nG40 Y#5421\nM2\n") == Code::compensation_conflict);
  CHECK_FALSE(run(contour + "(DEBUG,#5420)\n#1=EXISTS[#5420]\nX5\nG40\nG0 Y[#5420+1]\nM2\n")
                  .diagnostics.has_errors());
}
