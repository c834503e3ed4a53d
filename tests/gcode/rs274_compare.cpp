#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>

#include "rs274_trace.h"

namespace kadr::gcode::test {
namespace {

constexpr double kTextTolerance = 2e-6;
constexpr int kShorteningRuns = 150;
constexpr std::size_t kKindsShown = 8;  // of a family
constexpr std::size_t kContext = 5;

std::string text_of(const Call& call) {
  std::string text = call.name;
  for (const double v : call.numbers) text += fmt::format(" {:.5f}", v);
  return text;
}

/// Texts with numbers in them: these may differ in the last of their six decimals.
bool same_text(const std::string& own, const std::string& other) {
  if (own == other) return true;
  std::istringstream a(own), b(other);
  for (std::string left, right; true;) {
    const bool more_left = static_cast<bool>(a >> left), more_right = static_cast<bool>(b >> right);
    if (!more_left || !more_right) return more_left == more_right;
    if (left == right) continue;
    const std::size_t digit = left.find_first_of("+-.0123456789");
    if (digit == std::string::npos || left.substr(0, digit) != right.substr(0, digit)) return false;
    const double x = std::strtod(left.c_str() + digit, nullptr);
    const double y = std::strtod(right.c_str() + digit, nullptr);
    if (!(std::fabs(x - y) <= kTextTolerance * std::max(1.0, std::fabs(x)))) return false;
  }
}

bool same_call(const Call& own, const Call& other) {
  const bool text = other.name.rfind("MESSAGE ", 0) == 0 || other.name.rfind("PRINT ", 0) == 0;
  if (text) return same_text(own.name, other.name);
  if (own.name != other.name || own.numbers.size() != other.numbers.size()) return false;
  for (std::size_t k = 0; k < own.numbers.size(); ++k) {
    if (!(std::fabs(own.numbers[k] - other.numbers[k]) <= other.tolerance)) return false;
  }
  return true;
}

/// Whether a family is asked for by KADR_FAMILIES.
bool family_chosen(std::string_view family) {
  const char* chosen = std::getenv("KADR_FAMILIES");
  if (chosen == nullptr || *chosen == '\0') return true;
  std::istringstream names(chosen);
  for (std::string name; std::getline(names, name, ',');) {
    if (!name.empty() && family.substr(0, name.size()) == name) return true;
  }
  return false;
}

/// Mistakes that rs274 passes over because the word is not read, and kadr refuses: codes of the rows that
/// begin "a word that the line's code does not read" in docs/gcode.md.
constexpr std::array kRefusedByKadrAlone = {
    Code::word_repeated,   // rs274 takes a second Q after a negative one
    Code::word_not_whole,  // P of a code that ends before it is read: G5 P8.8 M66
    Code::spline_axis,     // B1 on G5.2
};

/// Whether every error of kadr is one of these.
bool refused_by_kadr_alone(const Trace& own) {
  return own.refused && std::all_of(own.errors.begin(), own.errors.end(), [](Code code) {
           return std::find(kRefusedByKadrAlone.begin(), kRefusedByKadrAlone.end(), code) !=
                  kRefusedByKadrAlone.end();
         });
}

/// One comparison; the two kinds of families differ in what counts as a disagreement.
struct Comparison {
  std::string rs274;
  bool verdict_only = false;

  /// Empty if both interpreters agree.
  std::string disagreement(const TestProgram& program) const {
    const Trace other = oracle_trace(rs274, program);
    if (other.no_verdict) return {};
    const Trace own = own_trace(program);
    if (verdict_only && (own.refused == other.refused || refused_by_kadr_alone(own))) return {};
    return first_difference(own, other);
  }
};

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// The same class of disagreement: which side refuses, or the names of the differing calls.
std::string kind_of(const std::string& difference) {
  std::string kind;
  std::size_t end = difference.find('\n');
  if (difference.find(" refuses ") < end) end = difference.find('\n', end + 1);
  for (const char c : difference.substr(0, end)) {
    if (std::isdigit(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-') kind += c;
  }
  return kind.substr(0, 120);
}

/// Leaves out lines, halves first, as long as the same disagreement remains.
TestProgram shortened(const Comparison& comparison, TestProgram program, const std::string& difference) {
  int runs_left = kShorteningRuns;
  std::vector<std::string> lines = lines_of(program.text);
  for (std::size_t piece = std::max<std::size_t>(lines.size() / 2, 1); piece >= 1 && runs_left > 0;) {
    bool shorter = false;
    for (std::size_t at = 0; at < lines.size() && runs_left > 0;) {
      std::vector<std::string> fewer = lines;
      const std::size_t end = std::min(at + piece, lines.size());
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(at),
                  fewer.begin() + static_cast<std::ptrdiff_t>(end));
      TestProgram candidate = program;
      candidate.text = joined(fewer);
      --runs_left;
      const std::string now = comparison.disagreement(candidate);
      if (!now.empty() && kind_of(now) == kind_of(difference)) {
        lines = fewer;
        shorter = true;
      } else {
        at += piece;
      }
    }
    if (!shorter) {
      if (piece == 1) break;
      piece /= 2;
    }
  }
  program.text = joined(lines);
  return program;
}

std::string shown(const TestProgram& program) {
  std::string text;
  const std::vector<std::string> lines = lines_of(program.text);
  for (std::size_t i = 0; i < lines.size(); ++i) text += fmt::format("{:5} | {}\n", i + 1, lines[i]);
  for (const Tool& tool : program.tools.tools) {
    text += fmt::format("tool T{} P{} X{} Y{} Z{} A{} D{} I{} J{} Q{}\n", tool.number, tool.pocket,
                        tool.offset[0], tool.offset[1], tool.offset[2], tool.offset[3], tool.diameter_mm,
                        tool.front_angle_deg, tool.back_angle_deg, tool.orientation);
  }
  for (const auto& [name, content] : program.files) text += "file " + name + ":\n" + content;
  return text;
}

void compare(std::string_view family, std::uint64_t fallback, const MakeProgram& make, bool verdict_only) {
  if (!family_chosen(family)) return;
  const Comparison comparison{find_rs274(), verdict_only};
  if (comparison.rs274.empty()) {
    MESSAGE("skipped: rs274 (package linuxcnc-uspace) is not installed; KADR_RS274 may name it");
    return;
  }
  const std::uint64_t programs = count(fallback);
  std::uint64_t agreed = 0, refused = 0, no_verdict = 0, listed = 0, differing = 0;
  // for writing generators: what does rs274 refuse?
  const bool oracle_only = environment("KADR_ORACLE_ONLY", 0) != 0;
  std::set<std::string> kinds;  // each is shown once
  for (std::uint64_t i = 0; i < programs; ++i) {
    Random random(seed() * 1000003 + i);
    const TestProgram program = make(random);
    const Trace other = oracle_trace(comparison.rs274, program);
    if (other.no_verdict) {
      ++no_verdict;
      continue;
    }
    if (other.refused) ++refused;
    if (oracle_only) {
      if (other.refused) MESSAGE(i << ": " << other.refusal);
      continue;
    }
    const Trace own = own_trace(program);
    if (verdict_only && !other.refused && refused_by_kadr_alone(own)) {
      ++listed;
      continue;
    }
    std::string difference =
        verdict_only && own.refused == other.refused ? std::string() : first_difference(own, other);
    if (difference.empty()) {
      ++agreed;
      continue;
    }
    ++differing;
    if (kinds.size() >= kKindsShown || !kinds.insert(kind_of(difference)).second) continue;
    const TestProgram minimal = shortened(comparison, program, difference);
    difference = comparison.disagreement(minimal);
    FAIL_CHECK(family, " ", i, " (seed ", seed(), "): ", difference, "\n", shown(minimal));
  }
  MESSAGE(family << ": " << programs << " programs compared, " << agreed << " agree, " << refused
                 << " refused by rs274, " << listed << " refused by kadr alone as listed, " << no_verdict
                 << " without a verdict of rs274");
  CHECK(differing == 0);
  // a generator of valid programs that mostly makes refused ones tests nothing
  if (!verdict_only && programs >= 20) CHECK(refused * 10 <= programs);
}

}  // namespace

std::string first_difference(const Trace& own, const Trace& other) {
  if (own.refused && other.refused) return {};
  if (own.refused) return "kadr refuses what rs274 runs\n" + own.refusal;
  if (other.refused) return "rs274 refuses what kadr runs\n" + other.refusal;
  std::size_t i = 0;
  while (i < own.calls.size() && i < other.calls.size() && same_call(own.calls[i], other.calls[i])) ++i;
  if (i == own.calls.size() && i == other.calls.size()) return {};
  const auto at = [i](const Trace& trace) {
    return i < trace.calls.size() ? text_of(trace.calls[i]) : std::string("(no more calls)");
  };
  std::string text = fmt::format("kadr {} | rs274 {}\n", at(own), at(other));
  for (std::size_t k = i - std::min(i, kContext); k < i; ++k)
    text += fmt::format("  both  {:4} {}\n", k, text_of(own.calls[k]));
  for (std::size_t k = i; k < std::min(i + 3, own.calls.size()); ++k)
    text += fmt::format("  kadr  {:4} {}   <- {}\n", k, text_of(own.calls[k]), own.calls[k].source);
  for (std::size_t k = i; k < std::min(i + 3, other.calls.size()); ++k)
    text += fmt::format("  rs274 {:4} {}   <- {}\n", k, text_of(other.calls[k]), other.calls[k].source);
  return text;
}

void compare_with_rs274(std::string_view family, std::uint64_t programs, const MakeProgram& make) {
  compare(family, programs, make, false);
}

void compare_verdict_with_rs274(std::string_view family, std::uint64_t programs, const MakeProgram& make) {
  compare(family, programs, make, true);
}

}  // namespace kadr::gcode::test
