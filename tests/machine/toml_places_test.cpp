#include "machine/file/toml_places.h"

#include <doctest/doctest.h>

#include <random>
#include <string>

#include "machine/base/utf8.h"
#include "machine/file/tree.h"
#include "tests/support/seed.h"

using namespace kadr;
using namespace kadr::machine;

namespace {

/// A key of that many parts.
std::string dotted(std::size_t parts, const std::string& part = "a") {
  std::string key = part;
  for (std::size_t i = 1; i < parts; ++i) key += "." + part;
  return key;
}

bool deep(const std::string& text) { return find_too_deep(text).has_value(); }

Diagnostics parse(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  parse_toml(sources, sources.add(SourceText("t.toml", text)), diagnostics);
  return diagnostics;
}

}  // namespace

TEST_CASE("code points of a line become bytes, in any order, as counted one by one") {
  std::mt19937_64 random(test::property_seed(5));
  std::string text;
  for (int i = 0; i < 3000; ++i) text += i % 700 == 699 ? "\n" : random() % 3 == 0 ? "д" : "x";
  TomlPlaces places(text);
  for (int i = 0; i < 2000; ++i) {
    const auto line = static_cast<std::uint32_t>(1 + random() % 6);
    const auto column = static_cast<std::uint32_t>(1 + random() % 800);
    std::size_t at = 0;
    for (std::uint32_t c = 1; c < column && at < places.line(line).size(); ++c)
      at += decode_utf8(places.line(line), at).bytes;
    CHECK(places.byte_column(line, column) == at + 1);
  }
}

TEST_CASE("lines of TOML are those of the text, without their ends") {
  const TomlPlaces places("one\r\ntwo\n\nfour");
  CHECK(places.line(0) == "");
  CHECK(places.line(1) == "one");
  CHECK(places.line(2) == "two");
  CHECK(places.line(3) == "");
  CHECK(places.line(4) == "four");
  CHECK(places.line(5) == "");
}

TEST_CASE("a key or header of 16 parts is read, one of 17 is found wherever it is") {
  for (const char* part : {"a", "\"a.b\"", "'a'", " a "}) {
    CAPTURE(part);
    CHECK_FALSE(deep(dotted(16, part) + " = 1\n"));
    CHECK(deep(dotted(17, part) + " = 1\n"));
    CHECK(deep("x = 1\n[" + dotted(17, part) + "]\n"));
    CHECK(deep("x = [1, {" + dotted(17, part) + " = 1}]\n"));
    CHECK(deep("x = \"\"\"\n\"\"\"\n" + dotted(17, part) + " = 1"));
    // texts that end in quotes hide nothing behind them
    for (const std::string quoted : {"\"\"\"x\"\"\"\"", "\"\"\"x\"\"\"\"\"", "\"\"\"\"\"\"", "\"\"",
                                     "\"\"\"\\\"\"\"\"\"", "'''x''''", "'''x'''''", "''"}) {
      CAPTURE(quoted);
      CHECK(deep("x = {b = " + quoted + ", " + dotted(17, part) + " = 1}\n"));
      CHECK_FALSE(deep("x = {b = " + quoted + ", " + dotted(16, part) + " = 1}\n"));
    }
  }
  // where a text of many lines in a key is not closed, the last line may be empty: one caret
  const auto behind = find_too_deep(dotted(20) + "\"\"\"\n");
  REQUIRE(behind);
  CHECK(behind->line == 2);
  CHECK(behind->length == 1);
  const auto found = find_too_deep("x = 1.5\n  " + dotted(20) + " = 1\n");
  REQUIRE(found);
  CHECK(found->line == 2);
  CHECK(found->begin == 2);
  CHECK(found->length == 39);
  CHECK(found->levels == 20);
}

TEST_CASE("dots in texts and comments, and of many numbers on one line, are no parts of a key") {
  const std::string dots(100, '.');
  CHECK_FALSE(deep("x = \"" + dots + "\"  # " + dots + "\n"));
  CHECK_FALSE(deep("x = '" + dots + "'\n"));
  CHECK_FALSE(deep("x = \"a\\\"" + dots + "\"\n"));
  CHECK_FALSE(deep("x = \"\"\"\n" + dots + "\n\"\"\"\n"));
  CHECK_FALSE(deep("x = '''\n" + dots + "\n'''\n"));
  std::string numbers = "x = [";
  for (int i = 0; i < 50; ++i) numbers += "1.5, ";
  CHECK_FALSE(deep(numbers + "]\n"));
}

TEST_CASE("keys and lists of any depth are refused with a place") {
  for (const std::string& text :
       {dotted(100'000) + " = 1\n", "[" + dotted(100'000) + "]\n", "x = {" + dotted(100'000) + " = 1}\n",
        "x = " + std::string(100'000, '[') + std::string(100'000, ']') + "\n"}) {
    const Diagnostics found = parse(text);
    REQUIRE(found.errors() == 1);
    CHECK(found.list().front().code == Code::file_too_deep);
    CHECK(found.list().front().span.line == 1);
  }
}

TEST_CASE("headers that are not closed are a mistake of the first one, however many there are") {
  for (const char* header : {"[axis\n", "  [[axis\n", "[[[[axis\n", "[axis] [[\n"}) {
    CAPTURE(header);
    std::string text = "\xEF\xBB\xBF";
    for (int i = 0; i < 33; ++i) text += header;
    CHECK_FALSE(deep(text));
    const Diagnostics found = parse(text);
    REQUIRE(found.has_errors());
    CHECK(found.list().front().code == Code::file_syntax);
    CHECK(found.list().front().span.line == 1);
  }
  // what is a list goes on over lines, whatever they begin with
  std::string list = "x = [\n";
  for (int i = 0; i < 32; ++i) list += "[\n";
  CHECK(deep(list));
  const Diagnostics found = parse(list);
  REQUIRE_FALSE(found.list().empty());
  CHECK(found.list().front().message == "lists or tables nested too deep");
}

TEST_CASE("what nests as deep as is allowed, in all ways at once, is read") {
  std::string value = "1";
  for (std::size_t i = 0; i < kMostNestedValues; ++i)
    value = "{" + dotted(kMostKeyParts) + " = " + value + "}";
  CHECK(parse("[" + dotted(kMostKeyParts, "t") + "]\n" + dotted(kMostKeyParts) + " = " + value + "\n")
            .list()
            .empty());
}

TEST_CASE("an array of 200 000 numbers on one line keeps the place of each") {
  std::string line = "x = [";
  for (int i = 0; i < 200'000; ++i) line += "1,";
  SourceSet sources;
  Diagnostics diagnostics;
  const auto file = sources.add(SourceText("t.toml", line + "]\n"));
  const ParsedTree tree = parse_toml(sources, file, diagnostics);
  REQUIRE(tree.root.entries.size() == 1);
  const auto& items = tree.root.entries.front().value.items;
  REQUIRE(items.size() == 200'000);
  for (std::size_t i = 0; i < items.size(); i += 1000) CHECK(items[i].span.column == 6 + 2 * i);
}
