#include "emulator/studies/teach/case_words.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace kadr::emulator {
namespace {

using lattice::Turn;
using Words = std::vector<std::string>;
using Numbers = std::vector<std::int64_t>;

/// The numbers of a case, and the turn that may follow them.
struct Given {
  Numbers numbers;
  std::string text;  ///< a polynomial
  bool turn_given = false;
  Turn turn = Turn::ccw;
};

CaseReading refused(CaseReading reading, CaseFault fault, std::string word = {}, std::size_t place = 0) {
  reading.fault = fault;
  reading.word = std::move(word);
  reading.place = place;
  return reading;
}

CaseFault read_steps(const std::string& text, std::int64_t& value) {
  const char *begin = text.data(), *end = begin + text.size();
  const auto [stop, error] = std::from_chars(begin + (!text.empty() && text[0] == '+'), end, value);
  if (error != std::errc{} || stop != end) return CaseFault::number;
  return value > kMostGiven_steps || value < -kMostGiven_steps ? CaseFault::beyond : CaseFault::none;
}

/// @return the word at fault, or nullptr
const std::string* read_numbers(const Words& words, bool polynomial, Given& given, CaseFault& fault) {
  std::size_t first = 1;
  if (polynomial && words.size() > 1) given.text = words[first++];
  for (std::size_t i = first; i < words.size(); ++i) {
    const bool last = i + 1 == words.size();
    if (last && (words[i] == "ccw" || words[i] == "cw")) {
      given.turn_given = true;
      given.turn = words[i] == "cw" ? Turn::cw : Turn::ccw;
      continue;
    }
    std::int64_t value = 0;
    fault = read_steps(words[i], value);
    if (fault != CaseFault::none) return &words[i];
    given.numbers.push_back(value);
  }
  return nullptr;
}

bool make_line(TeachCase& out, const Numbers& n) {
  if (n.size() < 2 || n.size() > lattice::kMostAxes) return false;
  lattice::LineCurve line{static_cast<int>(n.size()), {}};
  std::copy(n.begin(), n.end(), line.delta.begin());
  out.axes = line.axes;
  out.legs = {line};
  return true;
}

bool make_polyline(TeachCase& out, const Numbers& n, int axes) {
  const auto width = static_cast<std::size_t>(axes);
  if (n.empty() || n.size() % width != 0) return false;
  lattice::Point before{};
  out.axes = axes;
  for (std::size_t i = 0; i < n.size(); i += width) {
    lattice::LineCurve line{axes, {}};
    for (std::size_t k = 0; k < width; ++k) line.delta[k] = n[i + k] - std::exchange(before[k], n[i + k]);
    out.legs.push_back(line);
  }
  return true;
}

bool make_bezier(TeachCase& out, const Numbers& n, int axes) {
  const auto width = static_cast<std::size_t>(axes);
  const std::size_t points = n.size() / width;
  if (n.size() % width != 0 || points < 1 || points > 3) return false;
  lattice::BezierCurve bezier{axes, static_cast<int>(points), {}};
  for (std::size_t i = 0; i < n.size(); ++i) bezier.control[1 + i / width][i % width] = n[i];
  out.axes = axes;
  out.legs = {bezier};
  return true;
}

/// How many numbers a kind of plane curve takes.
std::size_t plane_count(const std::string& kind) {
  if (kind == "circle") return 1;
  if (kind == "ellipse") return 2;
  return kind == "parabola" ? 3 : 4;
}

CaseReading read_plane(CaseReading out, const Given& given) {
  const Numbers& n = given.numbers;
  const std::string& kind = out.subject.kind;
  if (kind == "parabola")
    for (const std::int64_t v : n)
      if (v < -kMostParabola_steps || v > kMostParabola_steps)
        return refused(std::move(out), CaseFault::far_parabola, std::to_string(v));
  if (n.size() != plane_count(kind)) return refused(std::move(out), CaseFault::count, {}, n.size());
  if (kind == "arc") out.subject.legs = {lattice::ArcCurve{{n[0], n[1]}, {n[2], n[3]}, given.turn}};
  if (kind == "circle") out.subject.legs = {lattice::ArcCurve{{n[0], 0}, {n[0], 0}, given.turn}};
  if (kind == "ellipse") {
    if (std::min(n[0], n[1]) < 1 || std::max(n[0], n[1]) > kMostHalfAxis_steps)
      return refused(std::move(out), CaseFault::half_axes);
    out.subject.legs = {lattice::ellipse(n[0], n[1], given.turn)};
  }
  if (kind == "parabola") {
    if (n[0] == 0) return refused(std::move(out), CaseFault::flat_parabola);
    out.subject.legs = {lattice::ParabolaCurve{n[0], n[1], n[2]}};
  }
  if (kind == "curve") {
    PolynomialReading f = read_terms(given.text);
    if (f.fault != CaseFault::none) return refused(std::move(out), f.fault, given.text, f.place);
    out.subject.legs = {lattice::ImplicitCurve{lattice::Polynomial(std::move(f.terms)),
                                               {n[0], n[1]},
                                               {n[2], n[3]},
                                               given.turn == Turn::ccw ? 1 : -1}};
  }
  out.subject.begin = lattice::begin_of(out.subject.legs.front());
  return out;
}

}  // namespace

const std::vector<TeachKind>& teach_kinds() {
  static const std::vector<TeachKind> kinds = {
      {"line", "DX DY [DZ ...]", "straight from the origin, 2 to 9 axes"},
      {"polyline", "X1 Y1 X2 Y2 ...", "lines from node to node; --axes, --mode ptp"},
      {"arc", "X0 Y0 X1 Y1 [ccw|cw]", "about the origin; a full turn where both ends coincide"},
      {"circle", "R [ccw|cw]", "a full turn from (R, 0)"},
      {"ellipse", "A B [ccw|cw]", "once around from (A, 0)"},
      {"parabola", "P Y0 Y1", "y^2 = 2 P x from Y0 to Y1"},
      {"curve", "'F(x,y)' X0 Y0 X1 Y1 [ccw|cw]", "F = 0; ccw: F < 0 to the left of travel"},
      {"bezier", "X1 Y1 [X2 Y2 [X3 Y3]]", "from the origin, degree 1 to 3; --axes"},
  };
  return kinds;
}

PolynomialReading read_terms(const std::string& text) {
  PolynomialReading out;
  std::size_t at = 0;
  const auto skip = [&] {
    while (at < text.size() && (text[at] == ' ' || text[at] == '*')) ++at;
  };
  const auto whole = [&](std::int64_t& value) {
    const auto [stop, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
    if (error != std::errc{}) return false;
    at = static_cast<std::size_t>(stop - text.data());
    return true;
  };
  const auto wrong = [&] {
    out.fault = CaseFault::polynomial;
    out.place = at + 1;
    return out;
  };
  for (skip(); at < text.size(); skip()) {
    std::int64_t sign = 1, c = 1;
    if (text[at] == '+' || text[at] == '-') {
      sign = text[at++] == '-' ? -1 : 1;
      skip();
    } else if (!out.terms.empty()) {
      return wrong();
    }
    const bool number = at < text.size() && text[at] >= '0' && text[at] <= '9';
    if (number && !whole(c)) return wrong();
    lattice::Term term{sign * c, 0, 0};
    bool any = number;
    for (skip(); at < text.size() && (text[at] == 'x' || text[at] == 'y'); skip()) {
      int& power = text[at++] == 'x' ? term.px : term.py;
      std::int64_t exponent = 1;
      if (at < text.size() && text[at] == '^') {
        ++at;
        if (!whole(exponent) || exponent < 0 || exponent > kMostPolynomialDegree) return wrong();
      }
      power += static_cast<int>(exponent);
      any = true;
    }
    if (!any) return wrong();
    if (term.px + term.py > kMostPolynomialDegree) {
      out.fault = CaseFault::degree;
      out.place = static_cast<std::size_t>(term.px + term.py);
      return out;
    }
    out.terms.push_back(term);
  }
  return out.terms.empty() ? wrong() : out;
}

CaseReading read_case(const Words& words, int axes) {
  CaseReading out;
  for (const TeachKind& k : teach_kinds())
    if (!words.empty() && words[0] == k.name) out.subject.kind = k.name;
  TeachCase& subject = out.subject;
  if (subject.kind.empty())
    return refused(std::move(out), CaseFault::kind, words.empty() ? std::string() : words[0]);
  for (const std::string& word : words) subject.title += (subject.title.empty() ? "" : " ") + word;
  Given given;
  CaseFault fault = CaseFault::none;
  if (const std::string* word = read_numbers(words, subject.kind == "curve", given, fault))
    return refused(std::move(out), fault, *word);
  const bool line = subject.kind == "line", polyline = subject.kind == "polyline",
             bezier = subject.kind == "bezier";
  if (given.turn_given && (line || polyline || bezier || subject.kind == "parabola"))
    return refused(std::move(out), CaseFault::turn);
  const Numbers& n = given.numbers;
  if (!line && !polyline && !bezier) return read_plane(std::move(out), given);
  const bool made = line       ? make_line(subject, n)
                    : polyline ? make_polyline(subject, n, axes)
                               : make_bezier(subject, n, axes);
  return made ? out : refused(std::move(out), CaseFault::count, {}, n.size());
}

}  // namespace kadr::emulator
