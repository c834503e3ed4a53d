#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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
  // the limits of mill3 are next to the measured values: X 2500 mm/s2
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
    "without script a page has its tables, path and charts; --plain has nothing else, as a build without "
    "Node") {
  const std::string& html = page().html;
  const std::string plain = call({"report", "p.lcmlog", "--plain", "-o", "-"}, page().scratch.path()).out;
  const Json pages = Json::parse(call({"version", "--json"}).out).at("pages");
  const bool interactive = pages.at("report") == true;
  CHECK(contains(html, "id=\"meta\"") == interactive);
  if (!interactive) CHECK(html == plain);
  CHECK_FALSE(contains(plain, "<script"));
  CHECK(contains(plain, "this build has no interactive page: ") == !interactive);
  for (const std::string& text : {html.substr(html.find(interactive ? "<noscript>" : "</table>")), plain}) {
    CHECK(contains(text, ">feed.commanded_mm_s<"));
    CHECK(contains(text, ">path.error_um<"));
    CHECK(contains(text, "Tool path as commanded, Y over X"));
  }
}

TEST_CASE(
    "a page without script draws the path to scale, rapids apart, and no programmed feed where there is "
    "none") {
  const Scratch scratch;
  scratch.write("p.ngc", "G21 G90 G94 G61\nG1 X40 F3000\nG0 Y20\nG1 X20\nM2\n");
  REQUIRE(call({"run", "p.ngc", "-m", "mill3", "-o", "p.lcmlog", "-q"}, scratch.path()).code == 0);
  REQUIRE(call({"report", "p.lcmlog", "--plain", "-q"}, scratch.path()).code == 0);
  const std::string html = scratch.read("p.html");
  // 40 mm and a margin of 4 % of them on either side are 858 pixels; is at 76 and Y21.6 at 32
  const double scale = 858 / 43.2;
  const std::string picture = html.substr(html.find("<svg "), html.find("</svg>") - html.find("<svg "));
  // strokes of a style in mm; the one before the last is the legend's
  const auto strokes = [&](const std::string& style) {
    const std::string begin = "<path class=\"line " + style + "\" d=\"";
    const auto from = picture.rfind(begin) + begin.size();
    std::vector<std::vector<std::array<double, 2>>> out;
    for (const char* at = picture.c_str() + from; *at == 'M' || *at == 'L';) {
      if (*at == 'M') out.emplace_back();
      char* end = nullptr;
      const double across = std::strtod(at + 1, &end), down = std::strtod(end, &end);
      out.back().push_back({(across - 76) / scale - 1.6, 21.6 - (down - 32) / scale});
      at = end;
    }
    return out;
  };
  const auto near = [](const std::array<double, 2>& point, double x_mm, double y_mm) {
    return std::hypot(point[0] - x_mm, point[1] - y_mm) < 0.02;
  };
  const auto feed = strokes("s0"), rapid = strokes("s1");
  REQUIRE(feed.size() == 2);
  REQUIRE(rapid.size() == 1);
  CHECK(near(feed[0].front(), 0, 0));
  CHECK(near(feed[0].back(), 40, 0));
  CHECK(near(rapid[0].front(), 40, 0));
  CHECK(near(rapid[0].back(), 40, 20));
  CHECK(near(feed[1].front(), 40, 20));
  CHECK(near(feed[1].back(), 20, 20));
  // the second line of the chart of feeds: two programmed stretches, nothing through the rapid
  const std::string chart = html.substr(html.find("</svg>") + 6);
  const std::string begin = "<path class=\"line s1\" d=\"";
  const auto from = chart.find(begin, chart.find("<g clip-path")) + begin.size();
  const std::string programmed = chart.substr(from, chart.find('"', from) - from);
  CHECK(std::count(programmed.begin(), programmed.end(), 'M') == 2);
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
      call({"report", "a.lcmlog", "-o", "small.html", "-q", "--max-size-mb", "0.24"}, scratch.path()).code ==
      0);
  const std::string small = scratch.read("small.html");
  CHECK(small.size() <= 240'000);
  CHECK_FALSE(contains(small, "\"every\":1,"));
  // each one around what matters
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
