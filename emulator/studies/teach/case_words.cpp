#include "emulator/studies/teach/case_words.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

namespace kadr::studies {
namespace {

namespace lattice = interpolator::lattice;

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

/// A plane curve that takes so many numbers.
CaseReading counted(CaseReading out, const Numbers& n, std::size_t count) {
  return n.size() == count ? out : refused(std::move(out), CaseFault::count, {}, n.size());
}

CaseReading read_ellipse(CaseReading out, const Given& given) {
  const Numbers& n = given.numbers;
  out = counted(std::move(out), n, 2);
  if (out.fault != CaseFault::none) return out;
  if (std::min(n[0], n[1]) < 1 || std::max(n[0], n[1]) > kMostHalfAxis_steps)
    return refused(std::move(out), CaseFault::half_axes);
  out.subject.legs = {lattice::ellipse(n[0], n[1], given.turn)};
  return out;
}

CaseReading read_parabola(CaseReading out, const Numbers& n) {
  for (const std::int64_t v : n)
    if (v < -kMostParabola_steps || v > kMostParabola_steps)
      return refused(std::move(out), CaseFault::far_parabola, std::to_string(v));
  out = counted(std::move(out), n, 3);
  if (out.fault != CaseFault::none) return out;
  if (n[0] == 0) return refused(std::move(out), CaseFault::flat_parabola);
  out.subject.legs = {lattice::ParabolaCurve{n[0], n[1], n[2]}};
  return out;
}

CaseReading read_curve(CaseReading out, const Given& given) {
  const Numbers& n = given.numbers;
  out = counted(std::move(out), n, 4);
  if (out.fault != CaseFault::none) return out;
  PolynomialReading f = read_terms(given.text);
  if (f.fault != CaseFault::none) return refused(std::move(out), f.fault, given.text, f.place);
  out.subject.legs = {lattice::ImplicitCurve{
      lattice::Polynomial(std::move(f.terms)), {n[0], n[1]}, {n[2], n[3]}, given.turn == Turn::ccw ? 1 : -1}};
  return out;
}

bool takes_turn(CaseKind kind) {
  switch (kind) {
    case CaseKind::line:
    case CaseKind::polyline:
    case CaseKind::bezier:
    case CaseKind::parabola:
      return false;
    case CaseKind::arc:
    case CaseKind::circle:
    case CaseKind::ellipse:
    case CaseKind::curve:
      return true;
  }
  return false;
}

/// The legs of a case.
CaseReading read_legs(CaseReading out, const Given& given, int axes) {
  const Numbers& n = given.numbers;
  TeachCase& subject = out.subject;
  const auto made = [&](bool fits) {
    return fits ? std::move(out) : refused(std::move(out), CaseFault::count, {}, n.size());
  };
  switch (subject.kind) {
    case CaseKind::line:
      return made(make_line(subject, n));
    case CaseKind::polyline:
      return made(make_polyline(subject, n, axes));
    case CaseKind::bezier:
      return made(make_bezier(subject, n, axes));
    case CaseKind::arc:
      out = counted(std::move(out), n, 4);
      if (out.fault == CaseFault::none)
        subject.legs = {lattice::ArcCurve{{n[0], n[1]}, {n[2], n[3]}, given.turn}};
      return out;
    case CaseKind::circle:
      out = counted(std::move(out), n, 1);
      if (out.fault == CaseFault::none) subject.legs = {lattice::ArcCurve{{n[0], 0}, {n[0], 0}, given.turn}};
      return out;
    case CaseKind::ellipse:
      return read_ellipse(std::move(out), given);
    case CaseKind::parabola:
      return read_parabola(std::move(out), n);
    case CaseKind::curve:
      return read_curve(std::move(out), given);
  }
  return out;
}

}  // namespace

std::string_view case_numbers(CaseKind kind) {
  switch (kind) {
    case CaseKind::line:
      return "DX DY [DZ ...]";
    case CaseKind::polyline:
      return "X1 Y1 X2 Y2 ...";
    case CaseKind::arc:
      return "X0 Y0 X1 Y1 [ccw|cw]";
    case CaseKind::circle:
      return "R [ccw|cw]";
    case CaseKind::ellipse:
      return "A B [ccw|cw]";
    case CaseKind::parabola:
      return "P Y0 Y1";
    case CaseKind::curve:
      return "'F(x,y)' X0 Y0 X1 Y1 [ccw|cw]";
    case CaseKind::bezier:
      return "X1 Y1 [X2 Y2 [X3 Y3]]";
  }
  return {};
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
  const auto kind = words.empty() ? std::nullopt : kCaseKinds.find(words[0]);
  if (!kind) return refused(std::move(out), CaseFault::kind, words.empty() ? std::string() : words[0]);
  TeachCase& subject = out.subject;
  subject.kind = *kind;
  for (const std::string& word : words) subject.title += (subject.title.empty() ? "" : " ") + word;
  Given given;
  CaseFault fault = CaseFault::none;
  if (const std::string* word = read_numbers(words, *kind == CaseKind::curve, given, fault))
    return refused(std::move(out), fault, *word);
  if (given.turn_given && !takes_turn(*kind)) return refused(std::move(out), CaseFault::turn);
  out = read_legs(std::move(out), given, axes);
  if (out.fault == CaseFault::none) subject.begin = lattice::begin_of(subject.legs.front());
  return out;
}

}  // namespace kadr::studies
