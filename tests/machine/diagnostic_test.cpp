#include "machine/base/diagnostic.h"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <system_error>

#include "machine/base/require.h"
#include "machine/base/terminal_text.h"
#include "machine/base/utf8.h"
#include "tests/support/seed.h"

using namespace kadr;

namespace {

Diagnostic arc_error(Span span) {
  return {Code::broken_promise,
          Severity::error,
          span,
          "arc end is not on the circle",
          "radius at start 5.000 mm, at end 5.590 mm, differ by 0.590 mm",
          {"allowed 0.010 mm (path.arc_end_tolerance_mm)", "start X20 Y10, centre X25 Y10"},
          "with this centre and X30 the end is Y10.000; or give R instead of I J"};
}

Diagnostic plain(Span span, std::string label) {
  return {Code::broken_promise, Severity::error, span, "headline", std::move(label), {}, ""};
}

/// Lines without control characters.
bool is_printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return c == '\n' || static_cast<unsigned char>(c) >= 0x20; });
}

std::string temporary(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("kadr_" + std::to_string(getpid()) + "_" + name))
      .string();
}

}  // namespace

TEST_CASE("a diagnostic shows code, place, line, caret, label, notes and help") {
  SourceSet sources;
  std::string program(41, '\n');
  program += "N420 G2 X30 Y12.5 I5 J0 (скругление)\n";
  const auto file = sources.add(SourceText("part.ngc", program));
  const Diagnostic d = arc_error({file, 42, 6, 18});
  CHECK(render_human(d, sources) ==
        "error[K9001]: arc end is not on the circle\n"
        "  --> part.ngc:42:6\n"
        "   |\n"
        "42 | N420 G2 X30 Y12.5 I5 J0 (скругление)\n"
        "   |      ^^^^^^^^^^^^^^^^^^ radius at start 5.000 mm, at end 5.590 mm, differ by 0.590 mm\n"
        "   |\n"
        "   = note: allowed 0.010 mm (path.arc_end_tolerance_mm)\n"
        "   = note: start X20 Y10, centre X25 Y10\n"
        "   = help: with this centre and X30 the end is Y10.000; or give R instead of I J\n"
        "   = more: kadr explain K9001\n");
  CHECK(render_gcc(d, sources) ==
        "part.ngc:42:6: error: arc end is not on the circle: radius at start 5.000 mm, at end 5.590 mm, "
        "differ by "
        "0.590 mm [K9001]");
}

TEST_CASE("the column counts code points, the caret stands by display width") {
  SourceSet sources;
  // "(дно) " is 9 bytes + 1 blank, 6 code points and 6 columns; a tab leads from column 6 to column 8
  const auto file = sources.add(SourceText("p.ngc", "(дно) \tG5 X1"));
  const std::string text = render_human(plain({file, 1, 11, 2}, "label"), sources);
  CHECK(text.find("--> p.ngc:1:8\n") != std::string::npos);
  CHECK(text.find("1 | (дно)   G5 X1\n") != std::string::npos);
  CHECK(text.find("\n  |         ^^ label\n") != std::string::npos);
}

TEST_CASE("wide and combining characters move the caret by two columns and by none") {
  SourceSet sources;
  const auto file = sources.add(SourceText("p", "加e\xCC\x81X"));
  const std::string text = render_human(plain({file, 1, 7, 1}, ""), sources);
  CHECK(text.find("--> p:1:4\n") != std::string::npos);
  CHECK(text.find("\n  |    ^\n") != std::string::npos);  // 2 + 1 + 0 columns before X
}

TEST_CASE("a span beyond the line's end gets one caret after the last character") {
  SourceSet sources;
  const auto file = sources.add(SourceText("p", "G1\n\nG2"));
  CHECK(render_human(plain({file, 1, 40, 5}, ""), sources).find("1 | G1\n  |   ^\n") != std::string::npos);
  CHECK(render_human(plain({file, 2, 1, 1}, ""), sources).find("2 |\n  | ^\n") != std::string::npos);
  CHECK(render_human(plain({file, 1, 2, 400}, ""), sources).find("1 | G1\n  |  ^\n") != std::string::npos);
}

TEST_CASE("without a place the measured value is a note, and the gcc form begins with kadr") {
  SourceSet sources;
  const Diagnostic d = plain({}, "measured 5");
  CHECK(render_human(d, sources) ==
        "error[K9001]: headline\n"
        "  = note: measured 5\n"
        "  = more: kadr explain K9001\n");
  CHECK(render_gcc(d, sources) == "kadr: error: headline: measured 5 [K9001]");
}

TEST_CASE("control characters and bytes that are not UTF-8 never reach the terminal") {
  SourceSet sources;
  const auto file = sources.add(SourceText("p", "a\x1b[2J\xff\x7f b"));
  const std::string text = render_human(plain({file, 1, 7, 1}, "value \x1b[31m\nnext"), sources);
  CHECK(is_printable(text));
  CHECK(text.find('\x7f') == std::string::npos);
  CHECK(text.find('\xff') == std::string::npos);
  CHECK(text.find("--> p:1:7\n") != std::string::npos);
  CHECK(render_gcc(plain({file, 1, 7, 1}, "two\nlines"), sources).find('\n') == std::string::npos);
}

TEST_CASE("of a line of 100,000 characters only the part round the caret is shown") {
  SourceSet sources;
  const auto file = sources.add(SourceText("p", std::string(50'000, 'x') + "ERR" + std::string(50'000, 'y')));
  const std::string text = render_human(plain({file, 1, 50'001, 3}, "here"), sources);
  CHECK(text.size() < 600);
  CHECK(text.find("--> p:1:50001\n") != std::string::npos);
  CHECK(text.find("1 | ..." + std::string(80, 'x') + "ERR" + std::string(80, 'y') + "...\n") !=
        std::string::npos);
  CHECK(text.find("\n  | " + std::string(83, ' ') + "^^^ here\n") != std::string::npos);
}

TEST_CASE(
    "long lines of tabs, wide characters and combining marks fill no screen, and the caret stands right") {
  // each of the three parts of an excerpt has 80 columns: 10 tabs, 40 wide characters, 80 marks
  for (const std::string piece : {"\t", "加", "\xCC\x81", "x"}) {
    CAPTURE(piece);
    std::string line;
    while (line.size() < 60'000) line += piece;
    const auto column = static_cast<std::uint32_t>(line.size()) + 1;
    SourceSet sources;
    const auto file = sources.add(SourceText("p", line + "ERR" + line));
    const std::string text = render_human(plain({file, 1, column, 3}, "here"), sources);
    CHECK(text.size() < 800);
    const std::size_t shown = text.find("1 | ") + 4;
    const std::size_t caret = text.find("\n  | ", shown) + 5;
    const std::size_t error = text.find("ERR", shown);
    std::size_t columns = 0;
    displayable(std::string_view(text).substr(shown, error - shown), columns);
    CHECK(text.find('^', caret) - caret == columns);
  }
}

TEST_CASE("a label that quotes a word of 60,000 bytes is cut") {
  SourceSet sources;
  const auto file = sources.add(SourceText("p", "X"));
  Diagnostic d = plain({file, 1, 1, 1}, std::string(60'000, '9'));
  d.help = d.message = d.label;
  CHECK(render_human(d, sources).size() < 2000);
  CHECK(render_gcc(d, sources).size() < 1500);
}

TEST_CASE("a mistake inside a subroutine tells the calls that led there, innermost first") {
  SourceSet sources;
  const auto program = sources.add(SourceText("part.ngc", "(деталь) O<bore> call [5] (hole)\nM2\n"));
  const auto sub = sources.add(SourceText("bore.ngc", "O<bore> sub\n O100 call [-1]\nO<bore> endsub\n"));
  Diagnostic d = plain({sub, 3, 1, 2}, "here");
  d.notes = {"allowed 5"};
  d.help = "write 5";
  // "(деталь) " is 9 code points and 15 bytes
  d.calls = {{sub, 2, 2, 14}, {program, 1, 16, 16}};
  const std::string text = render_human(d, sources);
  CHECK(text.find("  = note: allowed 5\n"
                  "  = note: called from bore.ngc:2:2: O100 call [-1]\n"
                  "  = note: called from part.ngc:1:10: O<bore> call [5]\n"
                  "  = help: write 5\n") != std::string::npos);
  CHECK(render_gcc(d, sources) ==
        "bore.ngc:3:1: error: headline: here [K9001]\n"
        "bore.ngc:2:2: note: called from here: O100 call [-1]\n"
        "part.ngc:1:10: note: called from here: O<bore> call [5]");
}

TEST_CASE("of a long chain of calls both ends are shown and the middle is counted") {
  SourceSet sources;
  const auto file = sources.add(SourceText("p", "O1\nO2\nO3\nO4\nO5\nO6\nO7\nO8\nO9\n"));
  Diagnostic d = plain({file, 1, 1, 2}, "");
  for (std::uint32_t line = 1; line <= 9; ++line) d.calls.push_back({file, line, 1, 2});
  const auto notes = [&] {
    std::string found;
    const std::string text = render_human(d, sources);
    for (std::size_t at = 0; (at = text.find("note: ", at)) != std::string::npos; ++at)
      found += text.substr(at + 6, text.find('\n', at) - at - 6) + '|';
    return found;
  };
  CHECK(notes() ==
        "called from p:1:1: O1|called from p:2:1: O2|called from p:3:1: O3|called from p:4:1: O4|"
        "... 1 further call ...|"
        "called from p:6:1: O6|called from p:7:1: O7|called from p:8:1: O8|called from p:9:1: O9|");
  d.calls.resize(2);
  d.calls_left_out = 98;
  CHECK(notes() == "called from p:1:1: O1|... 98 further calls ...|called from p:2:1: O2|");
}

TEST_CASE("colour changes nothing but escape sequences") {
  SourceSet sources;
  const auto file = sources.add(SourceText("p", "G1 X5"));
  const Diagnostic d = arc_error({file, 1, 4, 2});
  std::string coloured = render_human(d, sources, true);
  CHECK(coloured.find("\x1b[1;31m") != std::string::npos);
  for (std::size_t at = 0; (at = coloured.find('\x1b', at)) != std::string::npos;)
    coloured.erase(at, coloured.find('m', at) - at + 1);
  CHECK(coloured == render_human(d, sources));
}

TEST_CASE("lines are found with either line end, the last one without, and none beyond") {
  const SourceText t("p", "one\r\ntwo\n\nfour");
  CHECK(t.line(0) == "");
  CHECK(t.line(1) == "one");
  CHECK(t.line(2) == "two");
  CHECK(t.line(3) == "");
  CHECK(t.line(4) == "four");
  CHECK(t.line(5) == "");
  CHECK(SourceText("p", "").line(1) == "");
}

TEST_CASE("every line of a text of 1000 lines is found, in any order") {
  std::string text;
  for (int i = 1; i <= 1000; ++i) text += "line " + std::to_string(i) + "\n";
  const SourceText t("p", text);
  for (std::uint32_t i = 1000; i > 0; --i) CHECK(t.line(i) == "line " + std::to_string(i));
  CHECK(t.line(1001) == "");
  CHECK(t.line(4'000'000'000) == "");
}

TEST_CASE("a text stays where it is when it is moved, short or long") {
  SourceText a("p", "x");
  const char* at = a.text().data();
  SourceText b(std::move(a));
  CHECK(b.text().data() == at);
  CHECK(b.text() == "x");
  SourceSet set;
  const auto first = set.add(std::move(b));
  for (int i = 0; i < 100; ++i) set.add(SourceText("q", "y"));
  CHECK(set[first].text() == "x");
  CHECK(set.size() == 101);
}

TEST_CASE("files of 0 bytes, 1 kB and 5 MB read back as written") {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1000}, std::size_t{5'000'000}}) {
    std::string text(size, 'a');
    for (std::size_t i = 79; i < size; i += 80) text[i] = '\n';
    const std::string path = temporary("file");
    std::ofstream(path, std::ios::binary) << text;
    const SourceText read = SourceText::open(path, size);
    std::remove(path.c_str());
    CHECK(read.text() == text);
    CHECK(read.name() == path);
    if (size > 160) CHECK(read.line(2) == std::string(79, 'a'));
  }
}

namespace {

/// Why a file is not read; empty if it is.
std::string refusal(const std::string& path, std::uint64_t most_bytes) {
  try {
    SourceText::open(path, most_bytes);
  } catch (const UnreadableText& e) {
    CHECK(std::string(e.what()) == path + ": " + e.reason());
    return e.reason();
  }
  return "";
}

}  // namespace

TEST_CASE("a file that is missing, a folder, pipe or device is refused with its path, at once") {
  CHECK(refusal(temporary("no_such_file"), 1000) == "No such file or directory");
  CHECK(refusal(std::filesystem::temp_directory_path().string(), 1000) == "Is a directory");
  CHECK(refusal("/dev/zero", 1000) == "is a device or socket, not a file");
  const std::string pipe = temporary("pipe");
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(refusal(pipe, 1000) == "is a pipe, not a file; `-` reads standard input");
  std::remove(pipe.c_str());
}

TEST_CASE("a file above its bound is refused before it is read") {
  const std::string path = temporary("large");
  std::ofstream(path) << "text";
  CHECK(refusal(path, 4).empty());
  CHECK(refusal(path, 3) == "4 bytes; at most 3 are read");
  CHECK(refusal(path, 0).empty());
  // larger than memory
  std::filesystem::resize_file(path, std::uintmax_t{1} << 42);
  CHECK(refusal(path, kMostSettings_bytes) == "4398046511104 bytes; at most 8388608 are read");
  std::remove(path.c_str());
}

TEST_CASE("a text stays as it was read while its file is cut short") {
  const std::string path = temporary("cut");
  const std::string text(5'000'000, 'a');
  std::ofstream(path, std::ios::binary) << text;
  const SourceText read = SourceText::open(path, 0);
  std::filesystem::resize_file(path, 0);
  CHECK(read.text() == text);
  std::remove(path.c_str());
}

TEST_CASE("of any number of diagnostics 2000 errors and 2000 warnings are kept, of their texts 4000 bytes") {
  Diagnostics list;
  for (std::size_t i = 0; i < Diagnostics::kMost; ++i) {
    CHECK_FALSE(list.full());
    list.add(plain({}, ""));
  }
  CHECK(list.full());
  Diagnostic warning = plain({}, "");
  warning.severity = Severity::warning;
  for (std::size_t i = 0; i < 3 * Diagnostics::kMost; ++i) {
    list.add(plain({}, ""));
    list.add(warning);
  }
  CHECK(list.errors() == 4 * Diagnostics::kMost);
  CHECK(list.warnings() == 3 * Diagnostics::kMost);
  // and one note that says so
  CHECK(list.list().size() == 2 * Diagnostics::kMost + 1);
  CHECK(std::count_if(list.list().begin(), list.list().end(),
                      [](const Diagnostic& d) { return d.code == Code::too_many_errors; }) == 1);
  const auto rest = [](const Diagnostics& of) {
    return std::find_if(of.list().begin(), of.list().end(), tells_rest)->label;
  };
  CHECK(rest(list) == "6000 more errors and 4000 more warnings are not shown");
  CHECK(list.left_out() == 10'000);
  // what is left out is not forgotten when lists are put together or in order
  Diagnostics all;
  all.add(warning);
  all.add(list);
  all.sort_by_place();
  CHECK(all.errors() == 8000);
  CHECK(all.warnings() == 6001);
  CHECK(rest(all) == "6000 more errors and 4001 more warnings are not shown");
  all.stop({});
  CHECK(rest(all) ==
        "reading stopped here after 8000 errors; 6000 more errors and 4001 more warnings are not shown");

  Diagnostics long_texts;
  std::string label = "x";
  while (label.size() < 100'000) label += "\xD0\xBF";
  long_texts.add(plain({}, label));
  const std::string& kept = long_texts.list().front().label;
  CHECK(kept.size() <= Diagnostics::kMostText_bytes + 3);
  CHECK(kept.ends_with("..."));
  CHECK(is_utf8(kept));
}

TEST_CASE("lines of any length are found, in any order") {
  std::string text;
  for (int i = 1; i <= 20; ++i) text += std::to_string(i) + std::string(100'000, ' ') + "\n\n";
  const SourceText t("p", text);
  for (const std::uint32_t i : {20U, 1U, 7U, 19U, 2U}) {
    CHECK(t.line(2 * i - 1).starts_with(std::to_string(i) + " "));
    CHECK(t.line(2 * i) == "");
  }
}

TEST_CASE("errors and warnings are counted, notes are not") {
  Diagnostics list;
  CHECK_FALSE(list.has_errors());
  Diagnostic d = plain({}, "");
  list.add(d);
  list.add(d);
  d.severity = Severity::warning;
  list.add(d);
  CHECK(list.errors() == 2);
  CHECK(list.warnings() == 1);
  d.severity = Severity::note;
  list.add(d);
  CHECK(list.list().size() == 4);
  CHECK(list.errors() == 2);
  CHECK(list.warnings() == 1);
  CHECK(count_text(2, 1) == "2 errors, 1 warning");
  CHECK(count_text(1, 0) == "1 error");
  CHECK(count_text(0, 3) == "3 warnings");
  CHECK(count_text(0, 0) == "no errors");
}

TEST_CASE("a broken promise names the promise and the place without the path of the build") {
  CHECK_NOTHROW(require(true, "kept"));
  try {
    require(false, "two and two are four");
    FAIL("not thrown");
  } catch (const BrokenPromise& e) {
    const std::string what = e.what();
    CHECK(what.starts_with("two and two are four (machine/diagnostic_test.cpp:"));
  }
}

TEST_CASE("UTF-8 is told from CP1251, overlong forms and surrogates") {
  CHECK(is_utf8("деталь 加 \xF0\x9F\x98\x80"));
  CHECK_FALSE(is_utf8("\xE4\xE5\xF2\xE0\xEB\xFC"));  // "деталь" in CP1251
  CHECK_FALSE(is_utf8("\xC0\x80"));
  CHECK_FALSE(is_utf8("\xED\xA0\x80"));
  CHECK_FALSE(is_utf8("\xF4\x90\x80\x80"));
  CHECK_FALSE(is_utf8("\xE2\x82"));
  CHECK(count_code_points("дно") == 3);
  CHECK(count_code_points("\xff\xfe") == 2);
}

TEST_CASE("random bytes with random spans are always rendered, in lines without control characters") {
  std::mt19937_64 random(kadr::test::property_seed(5));
  for (int i = 0; i < 5000; ++i) {
    std::string bytes;
    for (std::uint64_t n = random() % 300; n > 0; --n) bytes += static_cast<char>(random());
    SourceSet sources;
    const auto file = sources.add(SourceText("p", bytes));
    const Span span{file, static_cast<std::uint32_t>(random() % 6),
                    static_cast<std::uint32_t>(random() % 400), static_cast<std::uint32_t>(random() % 400)};
    const std::string text =
        render_human(plain(span, bytes), sources) + render_gcc(plain(span, bytes), sources);
    CHECK(is_utf8(text));
    CHECK(is_printable(text));
  }
}
