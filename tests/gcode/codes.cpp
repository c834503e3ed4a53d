#include "gcode/dialect/codes.h"

#include <doctest/doctest.h>

#include <fstream>
#include <regex>
#include <set>
#include <string>

#include "gcode/interpret/letters.h"
#include "gcode/interpret/words.h"

using namespace kadr::gcode;

namespace {

/// The table "Words" of docs/gcode.md.
std::string words_of_the_page() {
  std::ifstream page(KADR_SOURCE_DIR "/docs/gcode.md");
  std::string text, line;
  bool inside = false;
  while (std::getline(page, line)) {
    if (line.starts_with("## ")) inside = line == "## Words";
    if (inside && line.starts_with("|")) text += line + "\n";
  }
  return text;
}

/// Codes of a letter that the page names, alone or in a range "G81 to G86"; G codes in tenths.
std::set<int> codes_of_the_page(char letter, bool (*runs)(int)) {
  const std::string text = words_of_the_page();
  const std::string number = std::string(1, letter) + "(\\d+)(?:\\.(\\d))?";
  const std::regex word("\\b" + number + "(?: to " + number + ")?");
  const auto value = [&](const std::smatch& m, std::size_t at) {
    const int whole = std::stoi(m[at]);
    return letter == 'M' ? whole : 10 * whole + (m[at + 1].matched ? std::stoi(m[at + 1]) : 0);
  };
  std::set<int> codes;
  for (auto m = std::sregex_iterator(text.begin(), text.end(), word); m != std::sregex_iterator(); ++m) {
    const int first = value(*m, 1);
    const bool range = (*m)[3].matched;
    codes.insert(first);
    if (!range) continue;
    codes.insert(value(*m, 3));
    for (int code = first; code < value(*m, 3); ++code)
      if (runs(code)) codes.insert(code);
  }
  return codes;
}

bool g_runs(int tenths) { return g_code(tenths).standing == Standing::runs; }
bool m_runs(int number) { return m_code(number).standing == Standing::runs; }

}  // namespace

TEST_CASE("docs/gcode.md lists every G code that runs, and no other") {
  const std::set<int> listed = codes_of_the_page('G', g_runs);
  for (int code = 0; code < 1000; ++code) {
    CAPTURE(g_name(code));
    CHECK(g_runs(code) == listed.contains(code));
  }
}

TEST_CASE("docs/gcode.md lists every M code that runs, and no other") {
  const std::set<int> listed = codes_of_the_page('M', m_runs);
  for (int code = 0; code < 1000; ++code) {
    CAPTURE(code);
    CHECK(m_runs(code) == listed.contains(code));
  }
}

TEST_CASE("the readers of a letter are those whose lines accept it") {
  CHECK(users_of('H') == "H belongs to G43 G43.2 G76");
  CHECK(users_of('O') == "no code that kadr runs reads this letter");
  CHECK(letters_of_g(code::g5_1) == letter_bits("IJ"));
  CHECK(letters_of_m(code::m67) == letter_bits("EQ"));
  CHECK(letters_of_m(kNoCode) == 0);
}
