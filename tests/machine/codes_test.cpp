#include "machine/base/codes.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

using namespace kadr;
namespace fs = std::filesystem;

namespace {

const fs::path kSource = KADR_SOURCE_DIR;

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("every code has a title without full stop and an explanation of at least 60 characters") {
  CHECK(all_codes().size() > 20);
  for (const CodeEntry& e : all_codes()) {
    CAPTURE(code_name(e.code));
    REQUIRE_FALSE(e.title.empty());
    CHECK(e.title.back() != '.');
    CHECK(e.title.size() <= 72);
    CHECK(e.explanation.size() >= 60);
    CHECK(e.explanation.find("  ") == std::string_view::npos);
  }
}

TEST_CASE("codes ascend, none is given twice, and each lies in K1xxx to K5xxx or K9xxx") {
  int last = 0;
  for (const CodeEntry& e : all_codes()) {
    const int number = static_cast<int>(e.code);
    CAPTURE(number);
    CHECK(number > last);
    CHECK(((number >= 1000 && number < 6000) || (number >= 9000 && number < 10000)));
    last = number;
  }
}

TEST_CASE("the long text of a code that a program can cause shows an example") {
  for (const CodeEntry& e : all_codes()) {
    const int number = static_cast<int>(e.code);
    if (number >= 3000) continue;
    CAPTURE(code_name(e.code));
    CHECK(e.explanation.find("xample") != std::string_view::npos);
  }
}

TEST_CASE("a code has one name and one title of its own") {
  std::set<std::string_view> names, titles;
  for (const CodeEntry& e : all_codes()) {
    CAPTURE(code_name(e.code));
    CHECK(names.insert(e.name).second);
    CHECK(titles.insert(e.title).second);
  }
}

TEST_CASE("each file of texts ascends by number, within the range that its first line names") {
  std::map<std::string, int> number_of;
  for (const CodeEntry& e : all_codes()) number_of[std::string(e.name)] = static_cast<int>(e.code);
  const std::regex head("^// K(\\d)xxx |^// K(\\d{4}) to K(\\d{4}) ");
  const std::regex entry("\nKADR_TEXT\\((\\w+),");
  std::size_t listed = 0;
  for (const auto& file : fs::directory_iterator(kSource / "machine/base/codes")) {
    const std::string text = contents(file.path());
    CAPTURE(file.path().string());
    std::smatch range;
    REQUIRE(std::regex_search(text, range, head));
    const bool whole = range[1].matched;
    const int least = whole ? std::stoi(range[1]) * 1000 : std::stoi(range[2]);
    const int most = whole ? least + 999 : std::stoi(range[3]);
    int last = least - 1;
    for (std::sregex_iterator it(text.begin(), text.end(), entry), end; it != end; ++it, ++listed) {
      const int number = number_of.at((*it)[1]);
      CAPTURE(number);
      CHECK(number > last);
      CHECK(number <= most);
      last = number;
    }
  }
  CHECK(listed == all_codes().size());
}

TEST_CASE("the texts of the codes are read by codes.cpp alone") {
  // an edited text must not rebuild files that only report the code
  for (const char* folder : {"machine", "gcode", "planner", "plant", "emulator", "scenarios"}) {
    for (const auto& file : fs::recursive_directory_iterator(kSource / folder)) {
      const std::string path = file.path().string();
      if ((!path.ends_with(".cpp") && !path.ends_with(".h")) || path.ends_with("machine/base/codes.cpp"))
        continue;
      CAPTURE(path);
      CHECK(contents(file.path()).find("base/code_texts.inc") == std::string::npos);
    }
  }
}

TEST_CASE("every code stands in a golden text of something bad, or in a test of its own") {
  std::string texts, tests;
  for (const auto& file : fs::recursive_directory_iterator(kSource / "tests")) {
    if (file.path().extension() == ".txt") texts += contents(file.path());
    if (file.path().extension() == ".cpp") tests += contents(file.path());
  }
  REQUIRE(texts.size() > 10'000);
  for (const CodeEntry& e : all_codes()) {
    // numerics fail in tests/plant/failures.cpp, below the code
    if (e.code == Code::plant_numerics) continue;
    CAPTURE(code_name(e.code));
    CHECK((texts.find('[' + code_name(e.code) + ']') != std::string::npos ||
           tests.find("Code::" + std::string(e.name)) != std::string::npos));
  }
}

TEST_CASE("a code is read with or without its K, and nothing else is a code") {
  CHECK(parse_code("K9001") == Code::broken_promise);
  CHECK(parse_code("k9001") == Code::broken_promise);
  CHECK(parse_code("9001") == Code::broken_promise);
  CHECK(code_name(Code::broken_promise) == "K9001");
  for (const char* bad : {"", "K", "K900", "K90011", "K9001x", "X9001", "-9001", "K0000"})
    CHECK_MESSAGE(!parse_code(bad), bad);
}
