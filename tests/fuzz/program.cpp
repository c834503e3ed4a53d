#include <cmath>
#include <string>

#include "checks.h"
#include "gcode/gcode.h"
#include "gcode/read/program.h"
#include "gcode/read/scanner.h"
#include "machine/base/require.h"

/// Scanner, parser and interpreter: whatever the text, blocks are finite and have their place, diagnostics
/// can be printed, the text prints back from its tree, and bounds end what would not end.
namespace {

using namespace kadr;
using namespace kadr::gcode;

constexpr std::size_t kMaxText_bytes = 16384;

/// What a program that begins with ";!" chooses by the next character; others run with everything plain.
struct Choices {
  explicit Choices(std::string_view text) {
    if (text.size() < 3 || text.substr(0, 2) != ";!") return;
    const auto bits = static_cast<unsigned char>(text[2]);
    dialect = kDialects.at((bits & 3U) | (bits >> 5U << 2U)).value_or(Dialect::linuxcnc);
    block_delete = (bits & 4U) != 0;
    stock = (bits & 8U) != 0;
    few_axes = (bits & 16U) != 0;
  }
  Dialect dialect = Dialect::linuxcnc;
  bool block_delete = false;
  bool stock = false;
  bool few_axes = false;
};

ToolTable small_table() {
  ToolTable table;
  for (int number : {1, 2, 3, 99999}) {
    Tool tool;
    tool.number = number;
    tool.pocket = number % 100;
    tool.offset[2] = 10.0 * number;
    tool.offset[0] = number == 3 ? 1.5 : 0;
    tool.diameter_mm = 0.5 * number;
    tool.orientation = number % 10;
    table.tools.push_back(tool);
  }
  return table;
}

InterpretOptions options_of(const Choices& choices) {
  InterpretOptions options;
  options.dialect = choices.dialect;
  options.block_delete = choices.block_delete;
  if (choices.few_axes) options.axis_letters = "XZC";
  options.g28 = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  options.g30 = {-1, -2, -3};
  options.bounds = {.blocks = 2000,
                    .lines = 50'000,
                    .messages = 1000,
                    .call_depth = 20,
                    .loop_passes = 2000,
                    .file_bytes = 1 << 20,
                    .line_bytes = 8192};
  options.tools = small_table();
  options.sub_folders = {KADR_SOURCE_DIR "/tests/fuzz/subs"};
  if (choices.stock) options.stock = StockPlane{.axis = 2, .position_u = -5, .below = true};
  options.read_input = [asked = 0](const InputWait& wait) mutable {
    ++asked;
    return InputReading{.reached = asked % 3 != 0, .value = wait.analog ? 0.5 * asked : asked % 2};
  };
  return options;
}

void check_finite(double value) { require(std::isfinite(value), "numbers of a block are finite"); }

void check_move(const Move& move) {
  for (const double v : move.end) check_finite(v);
  for (const double v :
       {move.length_u, move.feed_u_s, move.duration_s, move.path_tolerance_mm, move.pitch_u_rev})
    check_finite(v);
  require(move.length_u >= 0 && move.feed_u_s >= 0 && move.duration_s >= 0,
          "lengths, feeds and times are not negative");
}

struct CheckAction {
  void operator()(const Arc& arc) const {
    check_finite(arc.center_first_mm), check_finite(arc.center_second_mm);
    require(arc.turns != 0, "an arc turns");
  }
  void operator()(const Spline& spline) const {
    for (const SplinePoint& p : spline.control_points)
      check_finite(p.x_mm), check_finite(p.y_mm), check_finite(p.weight);
  }
  void operator()(const RigidTap& tap) const { check_finite(tap.retract_ratio); }
  void operator()(const Dwell& dwell) const {
    check_finite(dwell.time_s);
    require(dwell.time_s >= 0, "a dwell is not negative");
  }
  void operator()(const InputWait& wait) const { check_finite(wait.timeout_s); }
  void operator()(const SpindleMode& mode) const { check_finite(mode.maximum_rpm); }
  void operator()(const SpindleSpeed& speed) const { check_finite(speed.s_word); }
  void operator()(const AnalogOutput& output) const { check_finite(output.value); }
  void operator()(const auto&) const {}
};

void check_block(const Block& block, const SourceSet& sources) {
  fuzz::check_span(block.span, sources);
  if (const Move* move = move_of(block)) check_move(*move);
  std::visit(CheckAction{}, block.action);
  std::string line;
  append_canon(line, block);
  require(line.find('\n') == std::string::npos, "a call of the trace is one line");
}

/// Text -> tree -> text, and each plain number read by the careful way too.
void check_tree(const SourceSet& sources, std::uint32_t file, const ReadingBounds& bounds) {
  Diagnostics diagnostics;
  Report report(diagnostics);
  Names names;
  Program program(sources, file, bounds, names, report);
  std::string printed;
  while (const Line* at = program.next()) {
    const Line& line = *at;
    append_source(printed, line);
    for (const Item& item : line.items) {
      require(item.bytes.begin <= item.bytes.end && item.bytes.end <= line.text.size(),
              "items lie within the line");
      if (item.kind != ItemKind::word || item.value >= 0) continue;
      double value = 0;
      Bytes bytes;
      Cursor cursor(line.text, item.bytes.begin + 1);
      require(cursor.read_number(value, bytes) == NumberResult::good, "a plain number can be read");
      require(value == item.number && bytes.end == item.bytes.end, "both ways of reading a number agree");
    }
  }
  require(printed == sources[file].text(), "a program prints back byte for byte");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kMaxText_bytes) return 0;
  const std::string text(reinterpret_cast<const char*>(data), size);
  SourceSet sources;
  // a folder that is not there: calls of files find those of sub_folders only
  const auto file = sources.add(SourceText("/nowhere/fuzz.ngc", text));
  const InterpretOptions options = options_of(Choices(text));
  check_tree(sources, file, options.bounds);

  Diagnostics diagnostics;
  std::uint64_t blocks = 0;
  bool ended = false;
  interpret(
      sources, file, options,
      [&](const Block& block) {
        require(!ended, "nothing comes after the end of the program");
        ended = is<ProgramEnd>(block);
        require(++blocks <= options.bounds.blocks, "the bound on blocks holds");
        check_block(block, sources);
      },
      diagnostics);
  require(ended || diagnostics.has_errors(), "a program without errors ends");
  fuzz::check_diagnostics(diagnostics, sources);
  return 0;
}
