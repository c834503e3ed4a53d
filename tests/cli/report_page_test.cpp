#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::kSquare;
using kadr::test::Scratch;
using Json = nlohmann::json;

namespace {

/// A run of a program with markup in its comments that leaves mill3's travel, and the page of its log.
struct HostilePage {
  Scratch scratch;
  std::string html;
  HostilePage() {
    scratch.write("p.ngc",
                  "(</script><script>hacked</script> <!--DATA-->)\nG21 G90 G94\nG1 X20 F3000\n"
                  "G1 X310 (<img src=x onerror=hacked>)\nM2\n");
    REQUIRE(call({"run", "p.ngc", "-m", "mill3", "-o", "p.lcmlog", "-q"}, scratch.path()).code == 3);
    REQUIRE(call({"report", "p.lcmlog", "-q"}, scratch.path()).code == 0);
    html = scratch.read("p.html");
  }
};

const HostilePage& page() {
  static const HostilePage made;
  return made;
}

}  // namespace

TEST_CASE("kadr report writes one page whose numbers are the log's, and a second time the same bytes") {
  const std::string& html = page().html;
  CHECK(html.rfind("<!DOCTYPE html>", 0) == 0);
  CHECK(contains(html, "<h1>p.ngc on mill3</h1>"));
  const Json info = Json::parse(call({"info", "p.lcmlog", "--json"}, page().scratch.path()).out)[0];
  CHECK(contains(html, "<td>" + info["steps_hash"].get<std::string>() + "</td>"));
  // the limits of mill3 stand beside what was reached: X 2500 mm/s2
  CHECK(contains(html, " / 2 500.0 mm/s2"));
  CHECK(call({"report", "p.lcmlog", "-o", "-"}, page().scratch.path()).out == html);
  CHECK(html.size() < 2'000'000);
}

TEST_CASE("a page asks for nothing from elsewhere and shows a program's markup as text") {
  const std::string& html = page().html;
  CHECK(contains(html, "default-src 'none'"));
  CHECK_FALSE(contains(html, "hacked</script>"));
  CHECK_FALSE(contains(html, "<img"));
  CHECK(contains(html, "G1 X310 (&lt;img src=x onerror=hacked&gt;)"));
  CHECK_FALSE(contains(html, "src=\"http"));
  CHECK_FALSE(contains(html, "url(http"));
}

TEST_CASE("an alarm of a page has its code, instant and line, with a caret below the place") {
  const std::string& html = page().html;
  const auto alarms = html.find("id=\"alarms\"");
  REQUIRE(alarms != std::string::npos);
  const auto row = html.find("<tr class=\"alarm\" data-t=\"", alarms);
  REQUIRE(row != std::string::npos);
  const std::string text = html.substr(row, 600);
  CHECK(contains(text, "data-line=\"4\""));
  CHECK(contains(text, "<td>K5101</td>"));
  CHECK(contains(text, "<pre>4 | G1 X310 "));
  CHECK(contains(text, "\n  | ^"));
}

TEST_CASE(
    "without script a page has its tables and charts; a page of a build without Node has nothing else") {
  const std::string& html = page().html;
  const bool interactive = contains(html, "id=\"meta\"");
  const auto charts = interactive ? html.find("<noscript>") : html.find("<svg ");
  REQUIRE(charts != std::string::npos);
  CHECK(contains(html.substr(charts), ">feed.commanded_mm_s<"));
  CHECK(contains(html.substr(charts), ">path.error_um<"));
  if (!interactive) CHECK_FALSE(contains(html, "<script"));
}

TEST_CASE("a page of a log that breaks off says so, and the answer is no") {
  const Scratch scratch;
  scratch.write("square.ngc", kSquare);
  REQUIRE(call({"run", "square.ngc", "-o", "a.lcmlog", "-q"}, scratch.path()).code == 0);
  const std::string whole = scratch.read("a.lcmlog");
  scratch.write("cut.lcmlog", whole.substr(0, whole.size() / 2));
  const Finished run = call({"report", "cut.lcmlog", "-o", "cut.html"}, scratch.path());
  CHECK(run.code == 1);
  CHECK(contains(scratch.read("cut.html"), "What is shown ends at "));
  CHECK(call({"report", "none.lcmlog"}, scratch.path()).code == 2);
  CHECK(call({"report", "square.ngc"}, scratch.path()).code == 2);
}

TEST_CASE("a page keeps within its size: control ticks are gathered in twos, fours ... until it does") {
  const Scratch scratch;
  scratch.write("long.ngc", kadr::test::back_and_forth(20));
  REQUIRE(call({"run", "long.ngc", "-o", "a.lcmlog", "-q"}, scratch.path()).code == 0);
  REQUIRE(call({"report", "a.lcmlog", "-o", "whole.html", "-q"}, scratch.path()).code == 0);
  const std::string whole = scratch.read("whole.html");
  if (!contains(whole, "id=\"meta\"")) return;  // the plain form has no data to gather
  CHECK(contains(whole, "\"every\":1,"));
  REQUIRE(
      call({"report", "a.lcmlog", "-o", "small.html", "-q", "--max-size-mb", "0.23"}, scratch.path()).code ==
      0);
  const std::string small = scratch.read("small.html");
  CHECK(small.size() <= 230'000);
  CHECK_FALSE(contains(small, "\"every\":1,"));
  // each one round what matters all the same
  CHECK(contains(whole, "\"windows\":[],"));
  CHECK(contains(small, "\"windows\":[{\"first\":"));
}

TEST_CASE("kadr compare puts runs side by side with differences; a page draws them over each other") {
  // F600 is 10 mm/s; at 5 mm/s 70 mm of lines take 7 s longer
  const Scratch scratch;
  scratch.write("square.ngc", kSquare);
  REQUIRE(call({"run", "square.ngc", "-o", "a.lcmlog", "-q"}, scratch.path()).code == 0);
  REQUIRE(
      call({"run", "square.ngc", "-o", "b.lcmlog", "-q", "--set", "feed.max_mm_s=5"}, scratch.path()).code ==
      0);
  const Finished run = call({"compare", "a.lcmlog", "b.lcmlog", "-o", "c.html"}, scratch.path());
  CHECK(run.code == 0);
  CHECK(contains(
      run.out, "A  a.lcmlog   square.ngc on mill3, complete\nB  b.lcmlog   square.ngc on mill3, complete\n"));
  CHECK(contains(run.out, "path error, peak"));
  const Json j = Json::parse(call({"compare", "a.lcmlog", "b.lcmlog", "--json"}, scratch.path()).out);
  const Json &a = j["runs"][0], &b = j["runs"][1];
  CHECK(b["time_s"].get<double>() > a["time_s"].get<double>() + 3);
  CHECK(b["mean_feed_u_s"].get<double>() < a["mean_feed_u_s"].get<double>());
  CHECK(a["steps_hash"].get<std::string>().size() == 16);
  const Json info = Json::parse(call({"info", "a.lcmlog", "--json"}, scratch.path()).out)[0];
  CHECK(a["time_s"] == info["span_s"]);
  const std::string html = scratch.read("c.html");
  CHECK(contains(html, "<h2>Feed over the path</h2>"));
  // a build without Node draws three charts, one with it all signals of both runs
  CHECK(contains(html, "<script") == contains(html, "id=\"A-meta\""));
  CHECK(contains(html, "id=\"A-meta\"") == contains(html, "id=\"B-meta\""));
  CHECK(call({"compare", "a.lcmlog"}, scratch.path()).code == 2);
  CHECK(call({"compare", "a.lcmlog", "none.lcmlog"}, scratch.path()).code == 2);
}
