#include <doctest/doctest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

/// O words, named parameters, M98 and M99. Expected traces were compared with rs274 where it runs the program.
namespace {

/// Texts of (PRINT, ...) in the order they were run.
std::vector<std::string> printed(const std::string& text) {
  const Outcome outcome = run(text);
  CAPTURE(outcome.rendered);
  CHECK_FALSE(outcome.diagnostics.has_errors());
  std::vector<std::string> lines;
  for (const Comment& comment : outcome.all<Comment>()) lines.push_back(comment.text);
  return lines;
}

/// X of every move.
std::vector<double> xs(const Outcome& outcome) {
  std::vector<double> values;
  for (const LineOrArc& move : outcome.moves()) values.push_back(move.end[0]);
  return values;
}

using Texts = std::vector<std::string>;
using Values = std::vector<double>;

}  // namespace

TEST_CASE("a sub runs where it is called, before or behind its text, with its arguments") {
  CHECK(xs(run("O100 call [5]\nM2\nO100 sub\nG0 X#1\nO100 endsub\n")) == Values{5});
  CHECK(xs(run("O100 sub\nG0 X#1\nO100 endsub\nO100 call [5]\nO<100> call [6]\nM2\n")) == Values{5, 6});
  CHECK(printed("O<a b> sub\n(PRINT,#1 #2 #30)\nO<ab> endsub\nO<A b> call [1] [2]\nM2\n") ==
        Texts{"1.000000 2.000000 0.000000"});
  CHECK(xs(run("O[50*2] sub\nG0 X7\nO100 endsub\n#3=100\nO[#3] call\nM2\n")) == Values{7});
  // nested brackets and a comment behind the values
  CHECK(xs(run("O<x> sub (head)\nG0 X#1\nO<x> endsub\nO<x> call [#5+[3*2]] (cc)\nM2\n")) == Values{6});
  CHECK(xs(run("N10 o1 if [1]\nG0 X1\nN20 o 1 e n d i f ; c\nM2\n")) == Values{1});
}

TEST_CASE("thirty arguments, and parameters 1 to 30 belong to a call, others to all") {
  std::string call = "O1 call";
  for (int i = 1; i <= 30; ++i) call += " [" + std::to_string(i) + "]";
  CHECK(printed("O1 sub\n(PRINT,#1 #30 #31)\nO1 endsub\n" + call + "\nM2\n") ==
        Texts{"1.000000 30.000000 0.000000"});
  CHECK(printed("#5=3\nO1 sub\n(PRINT,#5 #31)\n#5=9\n#31=4\nO1 endsub\nO1 call\n(PRINT,#5 #31)\nM2\n") ==
        Texts{"0.000000 0.000000", "3.000000 4.000000"});
}

TEST_CASE("return and endsub give a value back") {
  const std::string sub = "o100 sub\no101 if [#1 GT 3]\no100 return [7]\no101 endif\no100 endsub [8]\n";
  CHECK(printed(sub + "o100 call [5]\n(PRINT,#<_value> #<_value_returned>)\n"
                      "o100 call [1]\n(PRINT,#<_value> #<_value_returned>)\nM2\n") ==
        Texts{"7.000000 1.000000", "8.000000 1.000000"});
  CHECK(printed("o1 sub\no1 endsub\no1 call\n(PRINT,#<_value> #<_value_returned>)\nM2\n") ==
        Texts{"0.000000 0.000000"});
}

TEST_CASE("a sub calls itself") {
  // 5! = 120 by recursion: each call keeps its own #1
  const std::string factorial =
      "O<f> sub\nO1 if [#1 LE 1]\nO<f> return [1]\nO1 endif\nO<f> call [#1-1]\nO<f> endsub [#1*#<_value>]\n";
  CHECK(xs(run(factorial + "O<f> call [5]\nG0 X#<_value>\nM2\n")) == Values{120});
  CHECK(xs(run("O1 sub\nO2 if [#1 GT 0]\nG0 X#1\nO1 call [#1-1]\nO2 endif\nO1 endsub\nO1 call [3]\nM2\n")) ==
        Values{3, 2, 1});
}

TEST_CASE("of the branches of a condition the first true one runs") {
  const std::string text =
      "O1 if [#1 EQ 1]\nG0 X1\nO1 elseif [#1 EQ 2]\nG0 X2\nO1 elseif [#1 GE 2]\nG0 X3\nO1 else\nG0 X4\nO1 "
      "endif\nM2\n";
  CHECK(xs(run("#1=1\n" + text)) == Values{1});
  CHECK(xs(run("#1=2\n" + text)) == Values{2});
  CHECK(xs(run("#1=3\n" + text)) == Values{3});
  CHECK(xs(run("#1=0\n" + text)) == Values{4});
}

TEST_CASE("while, do and repeat, left by break, shortened by continue") {
  CHECK(printed("#1=0\nO1 while [#1 LT 3]\n#1=[#1+1]\nO2 if [#1 EQ 2]\nO1 continue\nO2 endif\n(PRINT,#1)\n"
                "O1 endwhile\nM2\n") == Texts{"1.000000", "3.000000"});
  CHECK(printed("O1 do\n#1=[#1+1]\n(PRINT,#1)\nO2 if [#1 EQ 2]\nO1 break\nO2 endif\nO1 while [#1 LT 5]\n"
                "(PRINT,end)\nM2\n") == Texts{"1.000000", "2.000000", "end"});
  CHECK(printed("O1 do\n#1=[#1+1]\nO1 continue\nO1 while [#1 LT 3]\n(PRINT,#1)\nM2\n") == Texts{"3.000000"});
  CHECK(xs(run("O1 while [1]\nO2 while [1]\nO1 break\nO2 endwhile\nO1 endwhile\nG0 X1\nM2\n")) == Values{1});
  // 2.6 rounds to 3; 0, 1.4 and -3 to 0, 1 and none
  CHECK(printed("O1 repeat [2.6]\n(PRINT,a)\nO1 endrepeat\nO2 repeat [0]\n(PRINT,b)\nO2 endrepeat\n"
                "O3 repeat [1.4]\n(PRINT,c)\nO3 endrepeat\nO4 repeat [-3]\n(PRINT,d)\nO4 endrepeat\nM2\n") ==
        Texts{"a", "a", "a", "c"});
}

TEST_CASE("what loops leave behind acts on later loops, as in rs274") {
  // a repeat that is left continues with its remaining passes
  CHECK(
      printed(
          "O1 while [#1 LT 2]\n#1=[#1+1]\nO2 repeat [2]\n(PRINT,#1)\nO3 if [#1 EQ 1]\nO1 continue\nO3 endif\n"
          "O2 endrepeat\nO1 endwhile\nM2\n") == Texts{"1.000000", "2.000000"});
  // a while with a break in it, though it never ran: the do loop behind it makes one pass
  const std::string do_loop = "O3 do\n#1=[#1+1]\n(PRINT,#1)\nO3 while [#1 LT 3]\n";
  CHECK(printed("O1 while [0]\nO1 break\nO1 endwhile\n" + do_loop + "M2\n") == Texts{"1.000000"});
  CHECK(printed("O1 while [0]\nO1 endwhile\n" + do_loop + "M2\n") ==
        Texts{"1.000000", "2.000000", "3.000000"});
  // a continue in a do: the next repeat runs twice, but only the next one
  CHECK(printed("O1 do\nO1 continue\nO1 while [0]\nO2 repeat [2]\n(PRINT,a)\nO2 endrepeat\n"
                "O3 repeat [1]\n(PRINT,b)\nO3 endrepeat\nM2\n") == Texts{"a", "a", "a", "a", "b"});
  // ... or the next break of a while continues
  CHECK(printed("O1 do\nO1 continue\nO1 while [0]\nO2 while [#1 LT 3]\n#1=[#1+1]\n(PRINT,#1)\nO2 break\n"
                "O2 endwhile\nM2\n") == Texts{"1.000000", "2.000000"});
}

TEST_CASE("a definition that is passed over gives the value of its endsub") {
  CHECK(printed("o1 sub\no1 endsub [#1+2]\n(PRINT,#<_value> #<_value_returned>)\no2 sub\no2 endsub\n"
                "(PRINT,#<_value> #<_value_returned>)\nM2\n") ==
        Texts{"2.000000 1.000000", "0.000000 0.000000"});
  CHECK(printed("o1 sub\n#<x>=5\no1 endsub [#<x>+3]\n(PRINT,#<_value>)\no1 call\n(PRINT,#<_value>)\nM2\n") ==
        Texts{"3.000000", "8.000000"});
  // rs274 knows the sub from its call and refuses to meet it again
  CHECK(only_code("o1 call\no1 sub\no1 endsub\nM2\n") == Code::o_misplaced);
  CHECK_FALSE(run("o1 call\nM2\no1 sub\no1 endsub\n").diagnostics.has_errors());
}

TEST_CASE("M98 and M99 have lines of their own, as in rs274") {
  const std::string sub = "M2\nO100\nG0 X5\nM99\n";
  CHECK(only_code("G0 X1 M98 P100\n" + sub) == Code::o_word_place);
  // words after M98 are not run, but reported
  const Outcome passed_over = run("M98 P100 G0 Y1\n" + sub);
  CHECK_FALSE(passed_over.diagnostics.has_errors());
  CHECK(passed_over.moves().size() == 1);
  CHECK(passed_over.rendered.find("warning[K1101]") != std::string::npos);
  CHECK(only_code("M98 P100\nM2\nO100\nG0 X5 M99\n") == Code::o_word_place);
  // in the main program M99 is the end, as M2
  CHECK(run("M8\nG0 X1 M99\n").blocks.size() == run("M8\nG0 X1\nM2\n").blocks.size());
}

TEST_CASE("a message tells a value nearer to 0 than 0.0001 as 0, as rs274 does") {
  CHECK(printed("#1=0.00009 #2=-0.00009 #3=0.0001\n(PRINT,#1 #2 #3)\nM2\n") ==
        Texts{"0.000000 0.000000 0.000100"});
}

TEST_CASE("a name exists on the line that sets it, with the value 0") {
  CHECK(printed("#<n>=[#<n>+1]\n(PRINT,#<n>)\n#<n>=[#<n>+1]\n(PRINT,#<n>)\nM2\n") ==
        Texts{"1.000000", "2.000000"});
  CHECK(printed("#<m>=[EXISTS[#<m>]] #1=[EXISTS[#<k>]] #<k>=3\n(PRINT,#<m> #1)\nM2\n") ==
        Texts{"1.000000 0.000000"});
  CHECK(only_code("G0 X#<k> #<k>=3\n") == Code::name_not_set);
}

TEST_CASE("a return from within loops leaves them all") {
  CHECK(printed(
            "O1 call\n(PRINT,back)\nO1 call\nM2\nO1 sub\nO2 repeat [3]\nO3 while [1]\n(PRINT,in)\nO1 return\n"
            "O3 endwhile\nO2 endrepeat\nO1 endsub\n") == Texts{"in", "back", "in"});
}

TEST_CASE("labels of loops are their sub's own") {
  CHECK(xs(run("O1 sub\nO1 if [1]\nG0 X1\nO1 endif\nO1 endsub\nO1 if [1]\nG0 X2\nO1 endif\nO1 call\nM2\n")) ==
        Values{2, 1});
}

TEST_CASE("named parameters: local to a call, global with an underscore, set after their line") {
  CHECK(printed(
            "O1 sub\n#<x>=[#1+1]\n(PRINT,#<x> #<_g>)\nO1 endsub\n#<x>=5\n#<_g>=3\nO1 call [1]\n(PRINT,#<x>)\n"
            "M2\n") == Texts{"2.000000 3.000000", "5.000000"});
  CHECK(printed("#< A b >=5\n(PRINT,#<ab> #<AB> #<a b> #<nope>)\nM2\n") ==
        Texts{"5.000000 5.000000 5.000000 ######"});
  CHECK(xs(run("#<a>=1\n#<a>=2 G0 X#<a>\nX#<a>\nM2\n")) == Values{1, 2});
  const Outcome exists =
      run("G0 X[EXISTS[#<a>]] Y[EXISTS[#<_x>]] Z[EXISTS[#5]]\n#<a>=1\nG0 X[EXISTS[#<a>]]\nM2\n");
  CHECK(xs(exists) == Values{0, 1});
  CHECK(exists.moves()[0].end[1] == 1);
  CHECK(exists.moves()[0].end[2] == 1);
  CHECK(only_code("#<_x>=3\n") == Code::parameter_read_only);
}

TEST_CASE("predefined parameters tell the state as rs274 does") {
  const std::string state = "G20 G0 X1 Y2 Z3 A4\nT1 M6\nM3 S500\nF20\nG55 G18 G91 G99\nM7\nM8\n";
  const std::pair<const char*, const char*> expected[] = {{"_x", "1"},
                                                          {"_abs_y", "2"},
                                                          {"_a", "4"},
                                                          {"_line", "8"},
                                                          {"_metric", "0"},
                                                          {"_imperial", "1"},
                                                          {"_feed", "20"},
                                                          {"_rpm", "500"},
                                                          {"_plane", "180"},
                                                          {"_ccomp", "400"},
                                                          {"_absolute", "0"},
                                                          {"_incremental", "1"},
                                                          {"_mist", "1"},
                                                          {"_coord_system", "550"},
                                                          {"_flood", "1"},
                                                          {"_units_per_minute", "1"},
                                                          {"_vmajor", "2.9"},
                                                          {"_motion_mode", "0"},
                                                          {"_selected_tool", "1"},
                                                          {"_call_level", "0"}};
  for (const auto& parameter : expected) {
    CAPTURE(parameter.first);
    const Texts texts = printed(state + "(PRINT,#<" + parameter.first + ">)\nM2\n");
    REQUIRE(texts.size() == 1);
    CHECK(std::stod(texts[0]) == std::stod(parameter.second));
  }
  CHECK(printed("O1 call\nM2\nO1 sub\n(PRINT,#<_call_level>)\nO1 endsub\n") == Texts{"1.000000"});
}

TEST_CASE("M98 runs the lines from O to M99, with the caller's parameters, L times") {
  CHECK(xs(run("M98 P100 L2\nM2\nO100\nG91 G0 X5\nM99\n")) == Values{5, 10});
  CHECK(xs(run("M98 P100 L0\nG0 X1\nM2\nO100\nG0 X5\nM99\n")) == Values{1});
  CHECK(xs(run("#1=6\nM98 P100\nG0 X#1\nM2\nO100\nG0 X#1\n#1=[#1+4]\nM99\n")) == Values{6, 10});
  CHECK(xs(run("M98 P100\nG0 X1\nM30\nO100\nG91 G0 X5\nM98 P200 L2\nM99\nO200\nG0 Y1\nM99\n")) ==
        Values{5, 5, 5, 6});
  // named parameters are each call's own
  CHECK(printed("#<x>=5\nM98 P100\n(PRINT,#<x>)\nM2\nO100\n(PRINT,#<x>)\n#<x>=6\nM99\n") ==
        Texts{"######", "5.000000"});
  // a program number at the head is no subroutine to stumble over
  CHECK(xs(run("%\nO1234 (part)\nG0 X1\nM98 P5\nM30\nO5\nG0 X5\nM99\n%\n")) == Values{1, 5});
}

TEST_CASE("a message beside an O word is not run, and that is told") {
  const Outcome outcome = run("O1 if [1] (MSG, hi)\n(MSG, run)\nO1 endif (plain)\nM2\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::comment_not_run});
  CHECK(outcome.trace.front() == "MESSAGE \" run\"");
}

TEST_CASE("mistakes of text are told in subs and branches that never run, all at once") {
  CHECK(run("O1 if [0]\nG0 X1..2\nO1 endif\nO2 sub\nG1 X\nO2 endsub\nM2\n").codes() ==
        std::vector<Code>{Code::bad_number, Code::number_missing});
  // an O word that can't be read does not make its partner a mistake
  CHECK(only_code("O1 while #1 LT 3\nG0 X1\nO1 endwhile\nM2\n") == Code::o_arguments);
}

TEST_CASE("an error in a sub is told once, with the calls that led there") {
  const Outcome outcome =
      run("O1 sub\nG0 X[1/0]\nO1 endsub\nO2 sub\nO1 call\nO2 endsub\nO2 call\nO2 call\nM2\n");
  REQUIRE(outcome.codes() == std::vector<Code>{Code::division_by_zero});
  const Diagnostic& d = outcome.diagnostics.list().front();
  REQUIRE(d.calls.size() == 2);
  CHECK(d.calls[0].line == 5);
  CHECK(d.calls[1].line == 7);
}

TEST_CASE("an endless loop and an endless recursion end in a diagnostic") {
  InterpretOptions options;
  options.bounds.loop_passes = 100;
  CHECK(only_code("O1 while [1]\nO1 endwhile\nM2\n", options) == Code::loop_too_long);
  CHECK(only_code("O1 do\nO1 while [1]\nM2\n", options) == Code::loop_too_long);
  CHECK(only_code("O1 repeat [1000000000]\nO1 endrepeat\nM2\n", options) == Code::loop_too_long);
  CHECK(only_code("O1 while [1]\nO2 repeat [3]\nO1 continue\nO2 endrepeat\nO1 endwhile\n", options) ==
        Code::loop_too_long);
  options.bounds.call_depth = 20;
  CHECK(only_code("O1 sub\nO1 call\nO1 endsub\nO1 call\nM2\n", options) == Code::calls_too_deep);
  CHECK(only_code("M98 P1\nM2\nO1\nM98 P1\nM99\n", options) == Code::calls_too_deep);
  // a hundred passes are allowed
  CHECK(run("O1 repeat [100]\nO1 endrepeat\nM2\n", options).codes().empty());
}

TEST_CASE("block delete leaves out O words as other lines") {
  InterpretOptions options;
  options.block_delete = true;
  const std::string text = "/O1 if [0]\nG0 X1\n/O1 endif\nM2\n";
  CHECK(xs(run(text, options)) == Values{1});
  CHECK(xs(run(text)).empty());
}

TEST_CASE("loops in a text too long to be kept parsed run the same") {
  std::string filler;
  while (filler.size() < (1U << 20)) filler += "(" + std::string(200, 'c') + ")\n";
  CHECK(xs(run("G91\nO1 repeat [3]\nG0 X1\nO1 endrepeat\n" + filler +
               "O2 call\nM2\nO2 sub\nG0 X5\nO2 endsub\n")) == Values{1, 2, 3, 8});
}

namespace {

namespace fs = std::filesystem;

/// Folders with programs that are deleted at the end.
class Folder {
 public:
  Folder() : root_(fs::temp_directory_path() / fs::path("kadr_flow_" + std::to_string(::getpid()))) {
    fs::remove_all(root_);
    fs::create_directories(root_ / "parts");
    fs::create_directories(root_ / "subs");
  }
  ~Folder() { fs::remove_all(root_); }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(root_ / name, std::ios::binary) << text;
    return root_ / name;
  }
  fs::path operator/(const std::string& name) const { return root_ / name; }

 private:
  fs::path root_;
};

}  // namespace

TEST_CASE("a call finds its file beside the program, then in the folders given") {
  const Folder folder;
  folder.write("parts/near.ngc",
               "G0 X99\nO<near> sub\nG0 X#1\nO<other> call\nO<near> endsub [4]\n"
               "O<other> sub\nG0 X3\nO<other> endsub\n");
  folder.write("subs/far.ngc", "%\nO<far> sub\nG0 X8\nO<far> endsub\n%\n");
  folder.write("subs/6.ngc", "O6\nG0 X6\nM99\n");
  const std::string program = (folder / "parts/main.ngc").string();
  InterpretOptions options;
  options.sub_folders = {(folder / "subs").string()};
  const Outcome outcome =
      run("O<NEAR> call [1]\nG0 X[#<_value>+1]\nO<far> call\nO<other> call\nM98 P6\nM2\n", options, program);
  CAPTURE(outcome.rendered);
  CHECK(xs(outcome) == Values{1, 3, 5, 8, 3, 6});
  CHECK(run("O<far> call\nM2\n", {}, program).codes() == std::vector<Code>{Code::sub_not_found});
  // the file is there, the sub of its name is not
  folder.write("parts/empty.ngc", "G0 X1\n");
  CHECK(run("O<empty> call\nM2\n", {}, program).codes() == std::vector<Code>{Code::sub_file});
  // mistakes of a called file are reported at their position in it
  folder.write("parts/broken.ngc", "O<broken> sub\nG0 X1..2\nO<broken> endsub\n");
  const Outcome broken = run("O<broken> call\nM2\n", {}, program);
  CHECK(broken.codes() == std::vector<Code>{Code::bad_number});
  CHECK(broken.rendered.find("broken.ngc:2:") != std::string::npos);
}

TEST_CASE("a call opens nothing outside the program's folder and the folders given") {
  const Folder folder;
  folder.write("subs/secret.ngc", "O<secret> sub\nG0 X1\nO<secret> endsub\n");
  folder.write("parts/inside.ngc", "O<link2> sub\nG0 X2\nO<link2> endsub\n");
  fs::create_symlink(folder / "subs/secret.ngc", folder / "parts/link.ngc");
  fs::create_symlink(folder / "parts/inside.ngc", folder / "parts/link2.ngc");
  fs::create_directory(folder / "parts/folder.ngc");
  const std::string program = (folder / "parts/main.ngc").string();
  CHECK(run("O<link> call\nM2\n", {}, program).codes() == std::vector<Code>{Code::sub_file});
  CHECK(xs(run("O<link2> call\nM2\n", {}, program)) == Values{2});
  CHECK(run("O<..> call\nM2\n", {}, program).codes() == std::vector<Code>{Code::sub_file});
  CHECK(run("O<folder> call\nM2\n", {}, program).codes() == std::vector<Code>{Code::sub_file});
  CHECK(run("O<../subs/secret> call\nM2\n", {}, program).diagnostics.has_errors());
}

TEST_CASE("a file above its bound is not read") {
  const Folder folder;
  folder.write("parts/large.ngc", "O<large> sub\n" + std::string(500, ' ') + "\nO<large> endsub\n");
  InterpretOptions options;
  options.bounds.file_bytes = 200;
  CHECK(run("O<large> call\nM2\n", options, (folder / "parts/main.ngc").string()).codes() ==
        std::vector<Code>{Code::file_too_large});
}

TEST_CASE("a byte order mark and comments may stand before the first O word") {
  for (const std::string head : {"\xEF\xBB\xBF", "(only) ", "(o o) N5 (two) "}) {
    CAPTURE(head);
    const Outcome outcome = run(head + "O100 sub\nG0 X1\nO100 endsub\nO100 call\nM2\n");
    CHECK(outcome.diagnostics.list().empty());
    CHECK(outcome.moves().size() == 1);
  }
}

TEST_CASE("what can't be read behind M2 is a remark, until a subroutine begins") {
  const std::string sub = "o1 sub\nG0 X#1\no1 endsub\n";
  CHECK(last_point(sub + "o1 call [5]\nM2\nThese are notes, no words:\n 1 = 2\n")[0] == 5);
  CHECK(only_code("M98 P2\nM2\nnotes, no words\nO2\nG0 Y[\nM99\n") == Code::number_missing);
  CHECK(only_code(sub + "o1 call [5]\nnotes, no words\nM2\n") == Code::unknown_name);
}

TEST_CASE("behind an M2 with a mistake O words are not run") {
  CHECK(run("M2 #\no3 continue\n").diagnostics.list().size() == 1);
  CHECK(only_code("M2 Q1\no3 continue\n") == Code::word_unused);
}

TEST_CASE("nothing of a called file whose O words don't fit together is run, however often it is called") {
  const Folder folder;
  folder.write("parts/bad.ngc", "O<bad> sub\nO1 if [0]\nG0 X1\nO<bad> endsub\n");
  const Outcome outcome =
      run("O<bad> call\nO<bad> call\nM98 P1\nM2\n", {}, (folder / "parts/main.ngc").string());
  CHECK(outcome.diagnostics.has_errors());
  CHECK(outcome.moves().empty());
}

TEST_CASE("a break that is skipped on the way to a loop's end counts, wherever it is in the loop") {
  // the second break of o1 is passed over by its continue: the do loop behind ends after one pass
  const std::string text =
      "#1=0\no1 while [#1 LT 2]\n#1=[#1+1]\no2 if [0]\no1 break\no2 endif\no1 continue\no3 if [0]\no1 break\n"
      "o3 endif\no1 endwhile\n#2=0\no4 do\n#2=[#2+1]\nG0 X#2\no4 while [#2 LT 3]\nM2\n";
  CHECK(run(text).codes() == std::vector<Code>{Code::loop_mark_kept});
}
