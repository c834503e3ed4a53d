#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "rs274_generator.h"
#include "rs274_oracle.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// A line as words, each with the blanks behind it: "G1 X[2+1]" is "G1 " and "X[2+1]".
std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  int depth = 0;
  bool comment = false;
  for (const char c : line) {
    const bool begins = words.empty() || (depth == 0 && !comment &&
                                          (std::isupper(static_cast<unsigned char>(c)) != 0 || c == '(' ||
                                           c == '#' || c == '@' || c == '^' || c == ';') &&
                                          words.back().back() != '#' && words.back().back() != '=');
    if (begins) words.emplace_back();
    words.back() += c;
    if (c == '(') comment = true;
    if (c == ')') comment = false;
    if (!comment) depth += c == '[' ? 1 : c == ']' ? -1 : 0;
  }
  return words;
}

std::string one_text(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += word;
  return line;
}

/// Expressions that are mostly no expressions.
std::string doubtful_value(Random& random) {
  static const char* const kPieces[] = {
      "[1+2",     "[1 2]",  "1+2",        "[5 MOD 0]",  "SQRT[-1]",  "SQRT 4",  "ATAN[1]",   "[1/0]",
      "ACOS[2]",  "LN[0]",  "[2**0.5]",   "[[1]]",      "[-8**0.5]", "[]",      "[1,2]",     "[1 AND]",
      "SIN[1]+2", "[SIN]",  "#",          "##1",        "#-1",       "#5602",   "#5399",     "#[1.5]",
      "[1 == 1]", "[TRUE]", "EXISTS[#1]", "EXISTS[1]",  "[1 EQ 1]",  "+5",      "-[5]",      "- 5",
      "1 . 5",    "0x10",   "1e2",        "[1 MOD -2]", "[0**0]",    "[0**-1]", "EXP[1000]", "TAN[89]",
      "-#5220",   "#<_x>",  "#<nix>",     "[1!2]",      "+-5",       "+[5]",    "-+5",       "--5"};
  return kPieces[random.below(std::size(kPieces))];
}

/// One mistake that people make.
std::string with_mistake(Random& random, const std::string& line) {
  std::vector<std::string> words = words_of(line);
  if (words.empty()) return line;
  const std::size_t at = random.below(words.size());
  std::string& word = words[at];
  const auto other = [&] { return words[random.below(words.size())]; };
  switch (random.below(11)) {
    case 0:  // forgotten
      words.erase(words.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    case 1:  // twice
      words.insert(words.begin() + static_cast<std::ptrdiff_t>(at), other() + " ");
      break;
    case 2:  // another letter
      word[0] = std::string("ABCDEFGHIJKLMNPQRSTXYZ@^#$")[random.below(26)];
      break;
    case 3: {  // another code
      static const char* const kCodes[] = {"G4",    "G10",   "G28.1", "G33",   "G38.2", "G40", "G41", "G43",
                                           "G43.1", "G49",   "G5.1",  "G53",   "G61",   "G73", "G80", "G81",
                                           "G82",   "G90.1", "G92",   "G92.3", "G93",   "G95", "G96", "G98",
                                           "G2",    "G3",    "G5",    "G76",   "M6",    "M19", "M61", "M62",
                                           "M66",   "M68",   "M98",   "M99",   "M2",    "M3",  "M100"};
      word = std::string(kCodes[random.below(std::size(kCodes))]) + " ";
      break;
    }
    case 4: {  // another value
      static const char* const kValues[] = {"-1", "0",  "0.5", "1.0001", "99999", "1e3",  "-0",    "[1/0]",
                                            "",   "--", "[3]", "#99",    "#0",    "#<x>", "1.2.3", "."};
      word = word.substr(0, 1) + kValues[random.below(std::size(kValues))] + " ";
      break;
    }
    case 5: {  // a character lost
      const std::size_t c = random.below(word.size());
      word.erase(c, 1);
      break;
    }
    case 6: {  // a character too many
      const std::size_t c = random.below(word.size() + 1);
      word.insert(c, 1, "[]()#-+.*/=_,:!?\"<>~;&0AXG"[random.below(26)]);
      break;
    }
    case 7:  // at another place
      std::swap(word, words[random.below(words.size())]);
      break;
    case 8: {  // one more word
      static const char* const kWords[] = {"P1 ", "Q2 ", "R5 ", "L2 ", "D1 ", "H1 ", "K1 ", "I1 ",  "J1 ",
                                           "E1 ", "C1 ", "T1 ", "S5 ", "F0 ", "F5 ", "@5 ", "^45 ", "$1 ",
                                           "X1 ", "Z1 ", "M8 ", "M5 ", "G0 ", "A1 ", "O5 ", "#1=2 "};
      words.push_back(" " + std::string(kWords[random.below(std::size(kWords))]));
      break;
    }
    case 9:  // an expression with a mistake
      word = word.substr(0, 1) + doubtful_value(random) + " ";
      break;
    default:  // two lines in one
      words.push_back(" " + other());
      words.push_back(" " + other());
  }
  std::string damaged = one_text(words);
  // rs274 refuses a line that does not fit its buffer, whatever it says
  constexpr std::size_t kOracleLineBytes = 250;
  if (damaged.size() > kOracleLineBytes) return line;
  // rs274 takes the second of two polar words of a kind; kadr reports it
  for (const char polar : {'@', '^'}) {
    if (std::count(damaged.begin(), damaged.end(), polar) > 1) return line;
  }
  return damaged;
}

TestProgram damaged(Random& random, const Subjects& subjects) {
  TestProgram program = Generator(random, subjects).program();
  std::vector<std::string> lines;
  std::istringstream in(program.text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  // a few lines are enough: the first mistake ends the comparison
  const std::size_t keep = 2 + random.below(8);
  if (lines.size() > keep) lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(keep), lines.end());
  std::string& line = lines[1 + random.below(lines.size() - 1)];
  line = with_mistake(random, line);
  program.text.clear();
  for (const std::string& l : lines) program.text += l + "\n";
  program.text += "M2\n";
  return program;
}

}  // namespace

TEST_CASE("programs with one mistake are refused where rs274 refuses them") {
  compare_verdict_with_rs274(
      "mistakes", 100, [](Random& random) { return damaged(random, {.offsets = true, .machine = true}); });
}

TEST_CASE("programs of every family with one mistake are refused where rs274 refuses them") {
  compare_verdict_with_rs274("mixedmistakes", 100, [](Random& random) {
    Subjects subjects;
    for (bool* subject : {&subjects.offsets, &subjects.rotation, &subjects.machine, &subjects.polar,
                          &subjects.tools, &subjects.turning, &subjects.outputs, &subjects.stored,
                          &subjects.cycles, &subjects.splines, &subjects.threads, &subjects.probes})
      *subject = random.chance(0.3);
    return damaged(random, subjects);
  });
}
