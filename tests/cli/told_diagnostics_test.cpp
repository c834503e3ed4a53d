#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"

namespace test = kadr::test;
using kadr::test::call;
using kadr::test::check_golden;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;
using Json = nlohmann::json;

// What kadr says of mistakes, in each form.

namespace {

/// "codes in order of line" of a list of diagnostics
std::vector<std::string> codes(const Json& diagnostics) {
  std::vector<std::string> list;
  for (const Json& d : diagnostics) list.push_back(d["code"]);
  return list;
}

}  // namespace

TEST_CASE("six mistakes give six diagnostics with carets, exit 1, and nothing moves") {
  const Scratch scratch;
  scratch.write("six.ngc", test::kSixMistakes);
  const Finished run = call({"run", "six.ngc"}, scratch.path());
  CHECK(run.code == 1);
  CHECK(run.out.empty());
  CHECK(!scratch.has("six.lcmlog"));
  CHECK(!scratch.has("six.lcmlog.part"));
  CHECK(contains(run.err, "6 errors in six.ngc\n"));
  check_golden("six_mistakes.txt", run.err);

  const Finished json = call({"run", "six.ngc", "--json"}, scratch.path());
  CHECK(json.code == 1);
  const Json j = Json::parse(json.out);
  CHECK(j["diagnostics"].size() == 6);
  CHECK(j["run"].is_null());
  // one mistake in each of the lines 3 to 8
  for (std::size_t i = 0; i < j["diagnostics"].size(); ++i) CHECK(j["diagnostics"][i]["line"] == i + 3);

  const Finished check = call({"check", "six.ngc", "--json"}, scratch.path());
  CHECK(check.code == 1);
  CHECK(codes(Json::parse(check.out)[0]["diagnostics"]) == codes(j["diagnostics"]));
}

TEST_CASE("the gcc form has one line a diagnostic, --max-errors shows fewer") {
  const Scratch scratch;
  scratch.write("six.ngc", test::kSixMistakes);
  const Finished all = call({"check", "six.ngc", "--format", "gcc"}, scratch.path());
  CHECK(all.code == 1);
  CHECK(std::count(all.out.begin(), all.out.end(), '\n') == 6);
  CHECK(all.out.substr(0, 10) == "six.ngc:3:");
  CHECK(all.err.empty());
  const Finished two = call({"check", "six.ngc", "--format", "gcc", "--max-errors", "2"}, scratch.path());
  CHECK(std::count(two.out.begin(), two.out.end(), '\n') == 2);
  CHECK(contains(two.err, "4 more diagnostics not shown"));
  const Finished lines = call({"check", "six.ngc", "--format", "json"}, scratch.path());
  CHECK(std::count(lines.out.begin(), lines.out.end(), '\n') == 6);
  CHECK(Json::parse(lines.out.substr(0, lines.out.find('\n')))["line"] == 3);
}

TEST_CASE("how many diagnostics are not shown is said in every form, and no more than that") {
  const Scratch scratch;
  const std::string& folder = scratch.path();
  std::string axes, mistakes, warnings = "F1\n";
  for (int i = 0; i < 3000; ++i) axes += "[[axis]]\nname = \"Q\"\n";
  for (int i = 0; i < 3000; ++i) mistakes += "G1 X\n";
  for (int i = 0; i < 3000; ++i) warnings += "G4 P200\n";
  scratch.write("m.toml", axes);
  scratch.write("e.ngc", mistakes);
  scratch.write("w.ngc", warnings + "M2\n");
  const auto last_lines = [](const std::string& text, std::size_t count) {
    std::size_t at = text.size() - 1;
    for (; count > 0 && at != std::string::npos; --count) at = text.rfind('\n', at - 1);
    return text.substr(at + 1);
  };
  // readers that stop
  CHECK(last_lines(call({"check", "e.ngc"}, folder).out, 2) ==
        "at least 980 more not shown (--max-errors 0 shows 980 of them)\nat least 1000 errors in e.ngc\n");
  for (const char* most : {"0", "5"}) {
    CAPTURE(most);
    CHECK(contains(call({"check", "e.ngc", "--max-errors", most}, folder).out,
                   "reading stopped here after 1000 errors"));
    CHECK(contains(call({"check", "e.ngc", "--max-errors", most, "--format", "json"}, folder).out,
                   "reading stopped here after 1000 errors"));
    CHECK(contains(call({"check", "e.ngc", "--max-errors", most, "--format", "sarif"}, folder).out,
                   "reading stopped here after 1000 errors"));
    CHECK(contains(call({"machine", "check", "m.toml", "--max-errors", most}, folder).out,
                   "reading stopped here after 20"));
  }
  CHECK(contains(call({"check", "e.ngc", "--json"}, folder).out, "reading stopped here after 1000 errors"));
  CHECK(contains(call({"check", "e.ngc", "--max-errors", "5", "--format", "sarif"}, folder).out,
                 "at least 995 more diagnostics not shown"));
  // one that reads on: all are counted
  const Finished many = call({"check", "w.ngc"}, folder);
  CHECK(contains(many.out, "2980 more not shown (--max-errors 0 shows 980 of them)\n"));
  CHECK(contains(many.out, "3000 warnings in w.ngc\n"));
  for (const char* form : {"human", "json", "sarif", "gcc"})
    CHECK(contains(call({"check", "w.ngc", "--max-errors", "0", "--format", form}, folder).out,
                   "2000 more warnings are not shown"));
}

TEST_CASE("a machine file with mistakes: exit 2 of kadr run, exit 1 of kadr machine check, carets in both") {
  const Scratch scratch;
  call({"machine", "new", "shop"}, scratch.path());
  scratch.write("bad.toml", scratch.read("shop.toml") + "\n[nonsense]\nfoo = 1\n");
  scratch.write("square.ngc", test::kSquare);
  const Finished run = call({"run", "square.ngc", "-m", "bad.toml"}, scratch.path());
  CHECK(run.code == 2);
  CHECK(run.out.empty());
  CHECK(contains(run.err, "error[K3"));
  CHECK(contains(run.err, "--> bad.toml:"));
  CHECK(contains(run.err, "^"));
  CHECK(!scratch.has("square.lcmlog"));
  const Finished check = call({"machine", "check", "bad.toml"}, scratch.path());
  CHECK(check.code == 1);
  CHECK(contains(check.out, "error[K3"));
  const Finished unknown = call({"run", "square.ngc", "-m", "mill4"}, scratch.path());
  CHECK(unknown.code == 2);
  CHECK(unknown.err ==
        "kadr: machine mill4: No such file or directory; machines that ship with kadr: mill3, winder4, rig1, "
        "robot7\n");
  const Finished set = call({"run", "square.ngc", "--set", "path.no_such_key=1"}, scratch.path());
  CHECK(set.code == 2);
  CHECK(contains(set.err, "no_such_key"));
  const Json json = Json::parse(call({"run", "square.ngc", "-m", "bad.toml", "--json"}, scratch.path()).out);
  CHECK(json["exit_code"] == 2);
  CHECK(json["diagnostics"].size() >= 1);
}

TEST_CASE("kadr explain tells about a code, lists all, refuses unknown ones") {
  const Finished one = call({"explain", "K4101"});
  CHECK(one.code == 0);
  CHECK(one.out.substr(0, 7) == "K4101: ");
  CHECK(call({"explain", "4101"}).out == one.out);
  const Finished list = call({"explain", "--list"});
  CHECK(contains(list.out, "\nK5105  motor lost steps\n"));
  const Json all = Json::parse(call({"explain", "--list", "--json"}).out);
  CHECK(all.size() >= 20);
  for (const Json& entry : all) CHECK(entry["explanation"].get<std::string>().size() > 20);
  const Finished unknown = call({"explain", "K0001"});
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "there is no diagnostic 'K0001'"));
  CHECK(call({"explain"}).code == 2);
}

TEST_CASE("an M66 that waits in vain and an output that no motion follows are warnings with a place") {
  const Scratch scratch;
  scratch.write("outputs.ngc", "G21 G90\nG1 X10 F600\nM66 P3 L3 Q5\nM63 P1\nM2\n");
  const Finished check = call({"check", "outputs.ngc", "--format", "human"}, scratch.path());
  CHECK(check.code == 0);
  check_golden("check_outputs.txt", check.out);
}
