#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "emulator/studies/time_law/law_report.h"
#include "emulator/text/line_chart.h"

using namespace kadr;
using namespace kadr::studies;
using namespace kadr::text;

namespace {

/// A path of an axis in degrees over 100 mm, solved by the greedy method.
TimeLawProblem small_problem() {
  TimeLawProblem p;
  p.name = "small";
  p.axes = {{"B", "deg"}};
  p.formulas = {{0, 360, {}, {}}};
  planner::sample(p.formulas, 100, 11, p.law);
  p.law.max_feed_u_s = {90};
  p.law.max_accel_u_s2 = {180};
  p.law.path_feed_u_s = 50;
  return p;
}

}  // namespace

TEST_CASE("a law that breaks a limit is told with axis, place, value and limit, and the answer is no") {
  const TimeLawProblem problem = small_problem();
  LawStudy study = study_laws(problem, {PlanMethod::greedy}, false);
  REQUIRE(study.good());
  // a law that is twice as fast as found breaks what verify_law() looks at
  MethodOutcome& greedy = study.outcomes[0];
  for (double& v : greedy.law->speed_u_s) v *= 2;
  greedy.check = planner::verify_law(problem.law, *greedy.law, problem.path());
  CHECK_FALSE(study.good());
  const std::string text = render_law_checks(study, problem);
  CHECK(text.find("broken   greedy: axis B speed at s = ") != std::string::npos);
  CHECK(text.find(" deg/s, allowed 90\n") != std::string::npos);
  CHECK(text.find("broken   greedy: axis B acceleration at s = ") != std::string::npos);
  CHECK(text.find(" deg/s2, allowed 180\n") != std::string::npos);
  CHECK(text.find("limits   every law") == std::string::npos);
  const Json j = json_of(study, problem);
  CHECK(j["methods"][0]["broken"][0]["unit"] == "deg/s");
}

TEST_CASE("a method without a law has a row of dashes and a line with node and place") {
  TimeLawProblem problem = small_problem();
  problem.jerk_mm_s3 = 1e4;
  problem.law.end_u_s = 1;
  const LawStudy study = study_laws(problem, methods_of(problem), false);
  CHECK_FALSE(study.good());
  CHECK(render_law_table(study, false).find("\njerk-limited  ") != std::string::npos);
  CHECK(render_law_checks(study, problem).find("no law   jerk-limited: node 10, s = 100.000 mm: ") !=
        std::string::npos);
}

TEST_CASE("how the loop of the tube ended is told, whichever way it did") {
  TubeStory tube;
  tube.passes = {{1, 2.0, 2.0, 0, false, false, 0}, {2, 1.9, 1.9, 8, false, false, 0}};
  planner::TubeOptions options;
  planner::LawSolution law;
  law.time_s = law.cost_s = 1.9;
  options.least_half_width_u_s = 5;
  const std::string narrow = render_tube_log(tube, &law, 100, options);
  CHECK(narrow.find("Pass 2. Time per length 0.0190000 s/mm (total 1.9 s)\nHalf width of the tube: 8 mm/s\n"
                    "> No touches.\n>> Ended by the half width, the next one is below 5 mm/s.\n"
                    ">> FINAL TIME OF THE PATH: 1.9 s\n>> Half width of the tube: 4 mm/s\n") !=
        std::string::npos);
  tube.capped = true;
  options.most_passes = 2;
  CHECK(render_tube_log(tube, &law, 100, options).find(">> Ended by the number of passes, 2.\n") !=
        std::string::npos);
  tube.capped = false;
  tube.lost = planner::LawFailure{7, 12.5, "none can be reached"};
  CHECK(render_tube_log(tube, &law, 100, options)
            .find(">> The next pass finds no law at node 7, s = 12.500 mm.\n") != std::string::npos);
  law.cost_s = 2.0;
  CHECK(render_tube_log(tube, &law, 100, options).find(">> Pass 1 has the least J and is kept.\n") !=
        std::string::npos);
}

TEST_CASE("ticks are multiples of 1, 2 or 5 within the range, with the decimals they need") {
  const auto ticks = [](double low, double high, int wanted) {
    const std::vector<double> at = nice_ticks({low, high}, wanted);
    std::string text;
    for (const double x : at) text += tick_text(x, at.size() > 1 ? at[1] - at[0] : 1) + ";";
    return text;
  };
  CHECK(ticks(0, 2846.9, 10) == "0;500;1 000;1 500;2 000;2 500;");
  CHECK(ticks(0, 1.97, 10) == "0.0;0.2;0.4;0.6;0.8;1.0;1.2;1.4;1.6;1.8;");
  CHECK(ticks(-0.03, 0.05, 6) == "-0.02;0.00;0.02;0.04;");
  CHECK(ticks(653.7, 742.3, 6) == "660;680;700;720;740;");
  CHECK(ticks(0, 4e8, 6) == "0;1e+08;2e+08;3e+08;4e+08;");
}

TEST_CASE("a line of many points keeps lowest and highest of every pixel column") {
  LineChart chart;
  chart.id = "a";
  ChartLine line{"x", "y", {}, 1};
  for (int i = 0; i < 100'000; ++i) line.points.push_back({static_cast<double>(i), i == 54'321 ? 50.0 : 1.0});
  chart.lines.push_back(line);
  chart.y = ChartRange{0, 50};
  const std::string svg = render_svg(chart);
  CHECK(svg.size() < 60'000);
  // the one point at 50 is at the top of the plot: its y is that of the frame
  const auto frame = svg.find("class=\"frame\" d=\"M");
  const auto blank = svg.find(' ', frame + 17), end = svg.find('V', blank);
  const std::string top = svg.substr(blank, end - blank);
  CHECK(svg.find(top + "L", end) != std::string::npos);
}
