#include <doctest/doctest.h>
#include <fmt/format.h>

#include <set>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

/// Programs as the postprocessors of people's CAM systems write them, one style a controller: what the controller runs is
/// read without an error, and without a warning but those that a style stands for.
namespace {

/// Writes a program of random moves in one style.
class PostWriter {
 public:
  explicit PostWriter(Random& random) : random_(random) {}

  void line(const std::string& words) {
    text_ += (numbered_ ? fmt::format("N{} ", number_ += 5) : "") + words + "\n";
  }
  void remark(const std::string& words) { text_ += words + "\n"; }
  void number_lines() { numbered_ = true; }
  std::string text() const { return text_; }
  Random& random() { return random_; }
  int whole(int low, int high) {
    return low + static_cast<int>(random_.below(static_cast<std::uint64_t>(high - low + 1)));
  }
  bool chance(double p) { return random_.chance(p); }

  /// A coordinate as the style writes it: always with a point.
  std::string number(double value) const {
    std::string text = fmt::format("{:.{}f}", value, decimals_);
    if (!trims_) return text;
    while (text.back() == '0') text.pop_back();
    return text == "-0." ? "0." : text;
  }
  void trim_zeros() { trims_ = true; }
  void decimals(int count) { decimals_ = count; }

  /// "X12.5 Y3." of a new place.
  std::string place() {
    x_ = 0.5 * whole(-100, 100);
    y_ = 0.5 * whole(-100, 100);
    return fmt::format("X{} Y{}", number(x_), number(y_));
  }
  /// "X.. Y.. I.. J.." of a quarter or a half of a circle.
  std::string arc(bool clockwise) {
    const double radius = 0.5 * whole(1, 20);
    const double side = clockwise ? -1 : 1;
    const double i = -radius;
    if (chance(0.5)) {
      x_ += 2 * i;
      return fmt::format("X{} Y{} I{} J{}", number(x_), number(y_), number(i), number(0));
    }
    x_ += i;
    y_ += side * radius;
    return fmt::format("X{} Y{} I{} J{}", number(x_), number(y_), number(i), number(0));
  }

 private:
  Random& random_;
  std::string text_;
  double x_ = 0, y_ = 0;
  int number_ = 5, decimals_ = 3;
  bool numbered_ = false, trims_ = false;
};

/// Lines and arcs at one depth; the feed stands on the first.
void contour(PostWriter& post, const std::string& feed, const std::string& behind_arc = {}) {
  post.line("G1 " + post.place() + " " + feed);
  for (int n = post.whole(2, 15); n > 0; --n) {
    const bool clockwise = post.chance(0.5);
    if (post.chance(0.4)) {
      post.line((clockwise ? "G2 " : "G3 ") + post.arc(clockwise) + behind_arc);
    } else {
      post.line("G1 " + post.place());
    }
  }
}

std::string grbl_fusion(Random& random) {
  PostWriter post(random);
  post.trim_zeros();
  post.remark("(part 1)");
  post.remark("(T1 D=3.175 CR=0. - ZMIN=-1.5 - flat end mill)");
  post.line("G90 G94 G17");
  post.line("G21");
  post.line("M5");
  post.line("S12000 M3");
  post.line("G54");
  post.line("G0 " + post.place());
  post.line("Z5.");
  for (int n = post.whole(1, 4); n > 0; --n) {
    post.line("G1 Z-1. F200.");
    contour(post, "F800.");
    post.line("G0 Z5.");
  }
  post.line("M5");
  post.line("G28 G91 Z0.");
  post.line("G90");
  post.line("M30");
  return post.text();
}

std::string grbl_freecad(Random& random) {
  PostWriter post(random);
  post.remark("(Exported by FreeCAD)");
  post.remark("(Post Processor: grbl_post)");
  post.line("G17 G90");
  post.line("G21");
  post.remark("(Begin operation: Profile)");
  post.line("M3 S1000.000");
  post.line("G0 Z5.000");
  post.line("G0 " + post.place());
  post.line("G1 Z-1.000 F100.000");
  contour(post, "F500.000", " K0.000");
  post.line("G0 Z5.000");
  post.remark("(Finish operation)");
  post.line("M5");
  post.line("M2");
  return post.text();
}

std::string grbl_laser(Random& random) {
  PostWriter post(random);
  post.remark("; LightBurn 1.4");
  post.remark("$H");
  post.line("G00 G17 G40 G21 G54");
  post.line("G90");
  post.line("M4");
  post.line("M8");
  for (int n = post.whole(1, 6); n > 0; --n) {
    post.line("G0 " + post.place());
    post.line(fmt::format("G1 {} S{} F{}", post.place(), post.whole(0, 1000), post.whole(500, 6000)));
    post.line(post.place());
  }
  post.line("M9");
  post.line("G1 S0");
  post.line("M5");
  post.line("G90");
  post.line("G0 X0 Y0");
  post.line("M2");
  return post.text();
}

std::string grbl_inkscape(Random& random) {
  PostWriter post(random);
  post.decimals(4);
  post.remark(";svg > out.gcode");
  post.remark("% plotter on");
  post.line("G90");
  post.line("G21");
  post.line("G1 F1000");
  for (int n = post.whole(1, 6); n > 0; --n) {
    post.line("G1 " + post.place());
    post.line("M3 S200");
    post.line("G4 P0.1");
    post.line("G1 " + post.place() + " F400.0000");
    post.line("M5");
  }
  post.line("G1 F3000 X0 Y0");
  return post.text();
}

std::string mach3_vectric(Random& random) {
  PostWriter post(random);
  post.remark("( profile 2 )");
  post.remark("( Tool 1: End Mill {6 mm} )");
  post.number_lines();
  post.line("G00G21G17G90G40G49G80");
  post.line("G71G91.1");
  post.line("T1M06");
  post.line("G00G43Z20.000H1");
  post.line("S12000M03");
  post.line("G94");
  post.line("X0.000Y0.000F762.0");
  for (int n = post.whole(1, 4); n > 0; --n) {
    post.line("G00" + post.place() + "Z5.000");
    post.line("G1Z-2.000F250.0");
    contour(post, "F762.0");
    post.line("G00Z5.000");
  }
  if (post.chance(0.5)) {
    post.line("G99 G82 " + post.place() + " Z-3.000 R2.000 P500 F200.0");
    post.line(post.place());
    post.line("G80");
    post.line("Z20.000");
  }
  post.line("G00Z20.000");
  post.line("M09");
  post.line("M05");
  post.line("M30");
  return post.text();
}

std::string uccnc_bare_arcs(Random& random) {
  PostWriter post(random);
  post.line("G21 G90 G91.1");
  post.line("M3 S8000");
  post.line("G4 P2000");
  post.line("G0 Z5.000");
  post.line("G0 " + post.place());
  post.line("G1 Z-1.000 F300");
  for (int n = post.whole(1, 8); n > 0; --n) {
    const bool clockwise = post.chance(0.5);
    post.line(clockwise ? "G2" : "G3");
    post.line(post.arc(clockwise));
  }
  post.line("G0 Z5.000");
  post.line("M5");
  post.line("M30");
  return post.text();
}

std::string marlin_plotter(Random& random) {
  PostWriter post(random);
  post.remark("; slicer-less: a plotter on a printer's board");
  post.line("M107");
  post.line("G21");
  post.line("G90");
  post.line("G28 X Y");
  post.line("G92 E0");
  post.line("G0 F3000 Z5");
  for (int n = post.whole(1, 8); n > 0; --n) {
    post.line("G0 " + post.place());
    post.line("M106 S255");
    post.line("G4 P50");
    post.line(fmt::format("G1 {} F{}", post.place(), post.whole(300, 2400)));
    post.line("G1 " + post.place());
    post.line("M107");
  }
  post.line("M117 100% (done");
  post.line("M84 X Y");
  return post.text();
}

/// Fusion's posts for Fanuc and Haas are siblings.
std::string shop_mill(Random& random, bool haas) {
  PostWriter post(random);
  post.trim_zeros();
  post.remark("%");
  post.remark("O01001 (PART)");
  post.remark("(T1 D=10. CR=0. - ZMIN=-5. - FLAT END MILL)");
  post.number_lines();
  post.line("G90 G94 G17 G49 G40 G80");
  post.line("G21");
  if (haas && post.chance(0.5)) post.line("G187 P2");
  if (!haas && post.chance(0.5)) post.line("G05.1 Q1");
  post.line(haas ? "G53 G0 Z0." : "G28 G91 Z0.");
  post.line("G90");
  post.line("T1 M6");
  post.line("S5000 M3");
  post.line(post.chance(0.5) ? "G54" : haas ? "G154 P3" : "G54.1 P3");
  post.line("M8");
  post.line("G0 " + post.place());
  post.line("G43 Z15. H1");
  post.line("Z5.");
  post.line("G1 Z-2. F300.");
  contour(post, "F1000.");
  if (post.chance(0.5)) {
    post.line("G1 X100. Y100. ,R2.");
    post.line("X120. ,C1.");
    post.line("Y130.");
  }
  post.line("G0 Z15.");
  post.line("G98 G83 " + post.place() + " Z-12. R2. Q3. F200.");
  post.line(post.place());
  post.line("G80");
  post.line("Z15.");
  if (post.chance(0.5)) {
    if (!haas) post.line("M29 S500");
    post.line("S500 M3");
    post.line("G84 " + post.place() + " Z-10. R5. F500.");
    post.line(post.place());
    post.line("G80");
    post.line("G0 Z15.");
  }
  post.line("G4 P500");
  post.line("M9");
  post.line("M5");
  post.line("G0 G91 G28 Z0.");
  post.line("G90");
  post.line("M30");
  post.remark("%");
  return post.text();
}
std::string fanuc_fusion(Random& random) { return shop_mill(random, false); }
std::string haas_fusion(Random& random) { return shop_mill(random, true); }

struct PostStyle {
  const char* name;
  Dialect dialect;
  std::string (*write)(Random&);
  std::set<Code> warnings;  ///< that stand for the style
};
const PostStyle kStyles[] = {
    {"Fusion grbl", Dialect::grbl, grbl_fusion, {}},
    {"FreeCAD grbl", Dialect::grbl, grbl_freecad, {}},
    {"LightBurn grbl", Dialect::grbl, grbl_laser, {}},
    {"Inkscape grbl", Dialect::grbl, grbl_inkscape, {}},
    {"Vectric Mach3", Dialect::mach3, mach3_vectric, {Code::tool_length_unknown}},
    {"UCCNC", Dialect::mach3, uccnc_bare_arcs, {}},
    {"plotter Marlin", Dialect::marlin, marlin_plotter, {}},
    {"plotter RepRap", Dialect::reprap, marlin_plotter, {}},
    {"Fusion Fanuc", Dialect::fanuc, fanuc_fusion, {Code::tool_length_unknown}},
    {"Fusion Haas", Dialect::haas, haas_fusion, {Code::tool_length_unknown}},
};

}  // namespace

TEST_CASE(
    "programs as posts write them are read without errors, and without warnings but those of the style") {
  const std::uint64_t programs = count(100);
  for (const PostStyle& style : kStyles) {
    Random random(seed());
    InterpretOptions options;
    options.dialect = style.dialect;
    options.axis_letters = "XYZ";
    options.units_said = false;
    for (std::uint64_t i = 0; i < programs; ++i) {
      const std::string program = style.write(random);
      const Outcome outcome = run(program, options);
      CAPTURE(style.name);
      CAPTURE(program);
      CAPTURE(outcome.rendered);
      REQUIRE_FALSE(outcome.diagnostics.has_errors());
      for (const Diagnostic& d : outcome.diagnostics.list())
        if (d.severity == Severity::warning) REQUIRE(style.warnings.count(d.code) == 1);
      REQUIRE(outcome.moves().size() > 3);
    }
  }
}
