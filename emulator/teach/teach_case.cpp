#include "emulator/teach/teach_case.h"

#include <fmt/format.h>

#include <charconv>

namespace kadr::emulator {
namespace {

using lattice::Turn;
using Words = std::vector<std::string>;
using Numbers = std::vector<std::int64_t>;
using Read = tl::expected<TeachCase, std::string>;

constexpr int kMostDegree = 6;
constexpr std::int64_t kMostGiven = std::int64_t{1} << 61;  // differences of two still fit

tl::expected<std::int64_t, std::string> read_steps(const std::string& text) {
  std::int64_t value = 0;
  const char *begin = text.data(), *end = begin + text.size();
  const auto [stop, error] = std::from_chars(begin + (text.starts_with('+') ? 1 : 0), end, value);
  if (error != std::errc{} || stop != end)
    return tl::unexpected(fmt::format("'{}' is not a whole number of steps", text));
  if (value > kMostGiven || value < -kMostGiven)
    return tl::unexpected(fmt::format("'{}' is beyond {} steps", text, kMostGiven));
  return value;
}

/// The numbers of a case, and the turn that may stand behind them.
struct Given {
  Numbers numbers;
  std::string text;  ///< a polynomial
  bool turn_given = false;
  Turn turn = Turn::ccw;
};

tl::expected<Given, std::string> read_words(const Words& words, bool polynomial) {
  Given given;
  std::size_t first = 1;
  if (polynomial && words.size() > 1) given.text = words[first++];
  for (std::size_t i = first; i < words.size(); ++i) {
    const bool last = i + 1 == words.size();
    if (last && (words[i] == "ccw" || words[i] == "cw")) {
      given.turn_given = true;
      given.turn = words[i] == "cw" ? Turn::cw : Turn::ccw;
      continue;
    }
    const auto value = read_steps(words[i]);
    if (!value) return tl::unexpected(value.error());
    given.numbers.push_back(*value);
  }
  return given;
}

tl::unexpected<std::string> wrong_count(const std::string& kind, std::size_t count) {
  for (const TeachKind& k : teach_kinds())
    if (kind == k.name)
      return tl::unexpected(
          fmt::format("{} takes {}; got {} {}", kind, k.words, count, count == 1 ? "number" : "numbers"));
  return tl::unexpected(std::string());
}

Read line_case(TeachCase out, const Numbers& n) {
  if (n.size() < 2 || n.size() > lattice::kMostAxes) return wrong_count(out.kind, n.size());
  lattice::LineCurve line{static_cast<int>(n.size()), {}};
  std::copy(n.begin(), n.end(), line.delta.begin());
  out.axes = line.axes;
  out.legs = {line};
  return out;
}

Read polyline_case(TeachCase out, const Numbers& n, int axes) {
  const auto width = static_cast<std::size_t>(axes);
  if (n.empty() || n.size() % width != 0) return wrong_count(out.kind, n.size());
  lattice::Point before{};
  out.axes = axes;
  for (std::size_t i = 0; i < n.size(); i += width) {
    lattice::LineCurve line{axes, {}};
    for (std::size_t k = 0; k < width; ++k) line.delta[k] = n[i + k] - std::exchange(before[k], n[i + k]);
    out.legs.push_back(line);
  }
  return out;
}

Read bezier_case(TeachCase out, const Numbers& n, int axes) {
  const auto width = static_cast<std::size_t>(axes);
  const std::size_t points = n.size() / width;
  if (n.size() % width != 0 || points < 1 || points > 3) return wrong_count(out.kind, n.size());
  lattice::BezierCurve bezier{axes, static_cast<int>(points), {}};
  for (std::size_t i = 0; i < n.size(); ++i) bezier.control[1 + i / width][i % width] = n[i];
  out.axes = axes;
  out.legs = {bezier};
  return out;
}

Read curve_case(TeachCase out, const Given& given) {
  const Numbers& n = given.numbers;
  if (n.size() != 4) return wrong_count(out.kind, n.size());
  const auto f = read_polynomial(given.text);
  if (!f) return tl::unexpected(f.error());
  out.legs = {lattice::ImplicitCurve{*f, {n[0], n[1]}, {n[2], n[3]}, given.turn == Turn::ccw ? 1 : -1}};
  return out;
}

}  // namespace

const std::vector<TeachKind>& teach_kinds() {
  static const std::vector<TeachKind> kinds = {
      {"line", "DX DY [DZ ...]", "straight from the origin, 2 to 9 axes"},
      {"polyline", "X1 Y1 X2 Y2 ...", "lines from node to node; --axes, --mode ptp"},
      {"arc", "X0 Y0 X1 Y1 [ccw|cw]", "about the origin; a full turn where both ends are one node"},
      {"circle", "R [ccw|cw]", "a full turn from (R, 0)"},
      {"ellipse", "A B [ccw|cw]", "once around from (A, 0)"},
      {"parabola", "P Y0 Y1", "y^2 = 2 P x from Y0 to Y1"},
      {"curve", "'F(x,y)' X0 Y0 X1 Y1 [ccw|cw]", "F = 0; ccw: F < 0 to the left of travel"},
      {"bezier", "X1 Y1 [X2 Y2 [X3 Y3]]", "from the origin, degree 1 to 3; --axes"},
  };
  return kinds;
}

tl::expected<lattice::Polynomial, std::string> read_polynomial(const std::string& text) {
  std::vector<lattice::Term> terms;
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
    return tl::unexpected(
        fmt::format("'{}' can't be read from character {} on; a polynomial looks like "
                    "'6400 y - x^3'",
                    text, at + 1));
  };
  for (skip(); at < text.size(); skip()) {
    std::int64_t sign = 1, c = 1;
    if (text[at] == '+' || text[at] == '-') {
      sign = text[at++] == '-' ? -1 : 1;
      skip();
    } else if (!terms.empty()) {
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
        if (!whole(exponent) || exponent < 0 || exponent > kMostDegree) return wrong();
      }
      power += static_cast<int>(exponent);
      any = true;
    }
    if (!any) return wrong();
    if (term.px + term.py > kMostDegree)
      return tl::unexpected(
          fmt::format("'{}' is of degree {}, allowed {}", text, term.px + term.py, kMostDegree));
    terms.push_back(term);
  }
  if (terms.empty()) return wrong();
  return lattice::Polynomial(std::move(terms));
}

Read read_teach_case(const Words& words, int axes) {
  const TeachKind* kind = nullptr;
  std::string known;
  for (const TeachKind& k : teach_kinds()) {
    if (!words.empty() && words[0] == k.name) kind = &k;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", k.name);
  }
  if (kind == nullptr)
    return tl::unexpected(fmt::format("a case begins with one of {}; got '{}'", known,
                                      words.empty() ? std::string() : words[0]));
  TeachCase out;
  out.kind = kind->name;
  out.title = fmt::format("{}", fmt::join(words, " "));
  const auto given = read_words(words, out.kind == "curve");
  if (!given) return tl::unexpected(given.error());
  const Numbers& n = given->numbers;
  if (given->turn_given &&
      (out.kind == "line" || out.kind == "polyline" || out.kind == "parabola" || out.kind == "bezier"))
    return tl::unexpected(fmt::format("{} takes no ccw or cw", out.kind));
  const auto plane = [&](std::size_t count, auto&& make) -> Read {
    if (n.size() != count) return wrong_count(out.kind, n.size());
    out.legs = {make()};
    out.begin = lattice::begin_of(out.legs.front());
    return out;
  };
  if (out.kind == "line") return line_case(out, n);
  if (out.kind == "polyline") return polyline_case(out, n, axes);
  if (out.kind == "bezier") return bezier_case(out, n, axes);
  if (out.kind == "arc")
    return plane(4, [&] { return lattice::ArcCurve{{n[0], n[1]}, {n[2], n[3]}, given->turn}; });
  if (out.kind == "circle")
    return plane(1, [&] { return lattice::ArcCurve{{n[0], 0}, {n[0], 0}, given->turn}; });
  if (out.kind == "ellipse") {
    if (n.size() == 2 && (n[0] < 1 || n[1] < 1 || n[0] > 10'000 || n[1] > 10'000))
      return tl::unexpected(std::string("ellipse: half axes are 1 to 10000 steps"));
    return plane(2, [&] { return lattice::ellipse(n[0], n[1], given->turn); });
  }
  if (out.kind == "parabola") {
    for (const std::int64_t v : n)
      if (v < -(std::int64_t{1} << 29) || v > (std::int64_t{1} << 29))
        return tl::unexpected(fmt::format("parabola: {} is beyond 2^29 steps", v));
    if (n.size() == 3 && n[0] == 0) return tl::unexpected(std::string("parabola: P is not 0"));
    return plane(3, [&] { return lattice::ParabolaCurve{n[0], n[1], n[2]}; });
  }
  const auto curve = curve_case(out, *given);
  if (!curve) return curve;
  out = *curve;
  out.begin = lattice::begin_of(out.legs.front());
  return out;
}

}  // namespace kadr::emulator
