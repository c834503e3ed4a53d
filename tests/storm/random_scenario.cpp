#include "tests/storm/random_scenario.h"

#include "tests/storm/storm_case.h"

namespace kadr::storm {
namespace {

constexpr int kLastTick = 700;  // most runs are under way by then

class TimelineDraw {
 public:
  TimelineDraw(Draw& draw, const RandomMachine& machine, int most_pct)
      : d_(draw), m_(machine), most_pct_(most_pct) {}

  std::string make() {
    for (int n = d_.whole(0, 7); n > 0; --n) step();
    if (d_.chance(0.1)) return text_;
    // whatever was asked for, the program comes to its end
    at(kLastTick + 300);
    text_ += "override_pct = 100\n";
    at(kLastTick + 300);
    text_ += "rapid_override_pct = 100\n";
    at(kLastTick + 300);
    text_ += "spindle_load_pct = 0\n";
    return text_;
  }

 private:
  void at(int tick) { text_ += fmt::format("\n[[step]]\nat_tick = {}\n", tick); }
  /// A control tick, or now and then a place on the path.
  void moment() {
    if (d_.chance(0.85)) return at(d_.whole(0, kLastTick));
    text_ += "\n[[step]]\n";
    switch (d_.whole(0, 2)) {
      case 0:
        text_ += fmt::format("at_block = {}\n", d_.whole(0, 3));
        break;
      case 1:
        text_ += "at_path_mm = " + plain(m_.scale.move_u * d_.real(0, 2)) + "\n";
        break;
      default:
        text_ += "at_s = " + plain(m_.scale.tau_s * d_.whole(0, kLastTick), 9) + "\n";
    }
  }

  void step() {
    switch (d_.whole(0, 9)) {
      case 0:
      case 1: {
        const int tick = d_.whole(0, kLastTick);
        at(tick);
        text_ += "hold = true\n";
        if (d_.chance(0.03)) return;  // and nothing releases it
        at(tick + d_.whole(0, 150));
        text_ += "resume = true\n";
        break;
      }
      case 2:
        moment();
        text_ += fmt::format("rapid_override_pct = {}\n", d_.whole(5, 100));
        break;
      case 3:
        moment();
        text_ += fmt::format("spindle_load_pct = {}\n", d_.whole(20, 200));
        break;
      case 4: {
        // a dial that is turned
        const int tick = d_.whole(0, kLastTick), steps = d_.whole(2, 10);
        for (int i = 0; i < steps; ++i) {
          at(tick + 3 * i);
          text_ += fmt::format("override_pct = {}\n", d_.whole(10, most_pct_));
        }
        break;
      }
      case 5:
        if (d_.chance(0.8)) return;
        at(d_.whole(0, kLastTick));
        text_ += "emergency_stop = true\n";
        break;
      case 6: {
        const int tick = d_.whole(0, kLastTick);
        at(tick);
        text_ += "override_pct = 0\n";
        at(tick + d_.whole(1, 100));
        text_ += fmt::format("override_pct = {}\n", d_.whole(5, most_pct_));
        break;
      }
      default:
        moment();
        text_ += fmt::format("override_pct = {}\n", d_.whole(5, most_pct_));
    }
  }

  Draw& d_;
  const RandomMachine& m_;
  int most_pct_;
  std::string text_;
};

}  // namespace

void add_scenario(Draw& draw, const RandomMachine& machine, const RandomProgram& program,
                  StormCase& storm_case) {
  std::string head = "format = 1\nname = \"storm\"\nprogram = \"program.ngc\"\nmachine = \"machine.toml\"\n";
  if (storm_case.has(kToolsFile)) head += "tools = \"tools.tbl\"\n";
  if (program.dialect != "linuxcnc") head += "dialect = \"" + program.dialect + "\"\n";
  const bool has_operator = draw.chance(0.65);
  const int most_pct = draw.pick({100, 100, 120, 150, 200});
  if (has_operator) head += fmt::format("most_override_pct = {}\n", most_pct);
  if (!program.waits && draw.chance(0.06)) {
    head += "\n[[technology]]\nat_path_mm = " + plain(machine.scale.move_u * draw.real(0, 0.5));
    head += "\nmax_mm_s = " + plain(std::max(0.001, machine.scale.speed_u_s * draw.decades(0.05, 1))) + "\n";
  }
  if (program.waits)
    for (int n = draw.whole(0, 3); n > 0; --n) {
      head += fmt::format("\n[[step]]\nat_tick = {}\n", draw.whole(0, 400));
      head += fmt::format("input = {}\n", draw.whole(0, 3));
      head += fmt::format("value = {}\n", draw.whole(0, 1));
    }
  std::string& scenario = storm_case.files[kScenarioFile];
  scenario = head;
  if (!has_operator) return;
  scenario += TimelineDraw(draw, machine, most_pct).make();
  if (draw.chance(0.7)) storm_case.files[kOtherFile] = head + TimelineDraw(draw, machine, most_pct).make();
}

void enter_within(Draw& draw, StormCase& storm_case) {
  const std::string program = storm_case.text(kProgramFile);
  const auto lines = static_cast<int>(std::count(program.begin(), program.end(), '\n'));
  const int from = draw.whole(1, std::max(lines, 1));
  std::string keys = fmt::format("from_line = {}\n", from);
  if (draw.chance(0.3)) keys += fmt::format("to_line = {}\n", draw.whole(from, std::max(lines, from)));
  for (const char* file : {kScenarioFile, kOtherFile}) {
    if (!storm_case.has(file)) continue;
    std::string& text = storm_case.files[file];
    text.insert(text.find('\n') + 1, keys);
  }
}

std::string random_fault(Draw& draw) {
  const auto share = [&] { return plain(draw.real(0, 1), 3); };
  switch (draw.whole(0, 8)) {
    case 0:
      return "kill " + share() + "\n";
    case 1:
      return "signal 2 " + share() + "\n";
    case 2:
      return "signal 15 " + share() + "\n";
    case 3:
      return "fsize " + share() + "\n";
    case 4:
      return fmt::format("closed {}\n", draw.whole(1, 7));
    case 5:
      return draw.chance(0.5) ? "change replaced\n" : "change cut\n";
    case 6:
      return "race\n";
    default: {
      const std::string kind = draw.pick<std::string>(
          {"write", "short_write", "open", "rename", "fsync", "ftruncate", "flock", "unlink", "fchmod"});
      return fmt::format("call {} {}\n", kind, draw.whole(1, draw.chance(0.7) ? 4 : 40));
    }
  }
}

}  // namespace kadr::storm
