#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "support.h"

/// Differential tests against LinuxCNC's stand-alone interpreter (`rs274` of the Debian package
/// linuxcnc-uspace), if it is installed: KADR_RS274 names it, else it is looked for in PATH.
///
/// rs274 prints relative to the offsets in force and in program units; both sides are brought to machine
/// coordinates in mm and compared call for call.
namespace kadr::gcode::test {

/// One comparable call: a name and numbers in mm, machine coordinates.
struct Call {
  std::string name;
  std::vector<double> numbers;
  double tolerance = 0;  ///< of the numbers, from the four decimals of rs274
  std::string source;    ///< what was printed: for messages
};

struct Trace {
  std::vector<Call> calls;
  bool refused = false;
  bool no_verdict = false;   ///< rs274 only: some programs keep it busy for ever, or a signal ended it
  std::string refusal;       ///< what the interpreter says of it
  std::vector<Code> errors;  ///< kadr only
};

/// A program and the files next to it.
struct TestProgram {
  std::string text;
  ToolTable tools;
  /// The stand-alone rs274 takes the diameters of its table as inches where it compensates (25.4 here) and as
  /// they stand in #5410 (1).
  double diameter_unit_mm = 1;
  std::map<std::string, std::string> files;  ///< name ("sub.ngc") and text, in the program's folder
};

/// Path of rs274, empty if it is not installed.
std::string find_rs274();

/// What rs274 makes of a program, run in a temporary folder of its own.
Trace oracle_trace(const std::string& rs274, const TestProgram& program);

/// What kadr makes of it.
Trace own_trace(const TestProgram& program);

/// Where the traces part: the first differing call of each with the calls before it; empty if they agree.
/// Two refusals agree.
std::string first_difference(const Trace& own, const Trace& other);

using MakeProgram = std::function<TestProgram(Random&)>;

/// Compares `programs` generated programs and checks that all agree; a program that does not is shortened
/// line by line before it is shown. A generator of valid programs fails too if rs274 refuses what it makes.
///
/// KADR_SEED, KADR_COUNT (programs of each family) and KADR_FAMILIES (names, commas between; a prefix is
/// enough) choose what is run. Says so and returns if rs274 is not installed.
void compare_with_rs274(std::string_view family, std::uint64_t programs, const MakeProgram& make);

/// The same for programs that may be refused: kadr must refuse those that rs274 refuses, and no other, except
/// for the mistakes that docs/gcode.md lists as refused by kadr alone.
void compare_verdict_with_rs274(std::string_view family, std::uint64_t programs, const MakeProgram& make);

}  // namespace kadr::gcode::test
