#include "gcode/dialect/dialect_codes.h"

#include <algorithm>
#include <span>

/// A table a dialect: codes that LinuxCNC does not have, or reads otherwise. The sources stand beside the rules in
/// dialect.cpp.
namespace kadr::gcode {
namespace {

using enum CodeReading;

constexpr DialectCode as(char letter, int number, int meant, std::string_view lathe_letters = {}) {
  return {.letter = letter,
          .first = number,
          .last = number,
          .reading = runs,
          .meant = meant,
          .lathe_letters = lathe_letters};
}
constexpr DialectCode ends(char letter, int number, std::string_view letters = {},
                           std::string_view lathe_letters = {}) {
  return {.letter = letter,
          .first = number,
          .last = number,
          .reading = ends_nothing,
          .letters = letters,
          .lathe_letters = lathe_letters};
}
constexpr DialectCode tell(char letter, int first, int last, std::string_view letters,
                           std::string_view what) {
  return {.letter = letter, .first = first, .last = last, .reading = told, .letters = letters, .what = what};
}
constexpr DialectCode tell(char letter, int number, std::string_view letters, std::string_view what) {
  return tell(letter, number, number, letters, what);
}
constexpr DialectCode refuse(char letter, int first, int last, std::string_view what) {
  return {.letter = letter, .first = first, .last = last, .what = what};
}
constexpr DialectCode refuse(char letter, int number, std::string_view what) {
  return refuse(letter, number, number, what);
}
/// G110 to G129 of Haas: G154 P1 to P20.
constexpr DialectCode further_system(int tenths, int p) {
  return {
      .letter = 'G', .first = tenths, .last = tenths, .reading = runs, .meant = code::g54_1, .given_p = p};
}

constexpr std::string_view kLathe = "a cycle of lathes (code system A)";
constexpr std::string_view kScaling = "scales the program";
constexpr std::string_view kTurned = "turns the program's axes";
constexpr std::string_view kMirror = "mirrors the program";
constexpr std::string_view kPolar = "reads X and Y as radius and angle";
constexpr std::string_view kLookAhead = "sets the look-ahead of the controller";
constexpr std::string_view kRigid = "announces rigid tapping: taps of kadr are rigid";
constexpr std::string_view kShift = "moves the tool by its radius once";
constexpr std::string_view kBoring = "fine boring: the tool is oriented, moves aside and comes back";

constexpr DialectCode kMach3Codes[] = {
    refuse('G', 120, "cuts a round pocket"),
    refuse('G', 130, "cuts a round pocket"),
    ends('G', 150),
    refuse('G', 160, kPolar),
    as('G', 310, code::g31),
    ends('G', 500),
    refuse('G', 510, kScaling),
    refuse('G', 680, kTurned),
    ends('G', 690),
    as('G', 700, code::g20),
    as('G', 710, code::g21),
    refuse('G', 770, "a cycle of threads"),
    refuse('G', 780, "a cycle of threads"),
    tell('M', 10, 11, "PQ", "switches the laser of Mach3 and UCCNC"),
    tell('M', 40, 41, "", "opens and closes the file of a digitized surface"),
    refuse('M', 47, "begins the program anew, without end"),
};

constexpr DialectCode kFanucCodes[] = {
    tell('G', 50, "PQR", kLookAhead),
    tell('G', 51, "*", kLookAhead),
    refuse('G', 52, "a path on a plane that the controller interpolates"),
    refuse('G', 70, "gives an axis no motion of its own"),
    refuse('G', 71, "winds the path round a cylinder"),
    tell('G', 80, "PQ", kLookAhead),
    tell('G', 90, "", "stops exactly at the end of its line"),
    refuse('G', 121, "moves X and C as a plane"),
    ends('G', 131),
    ends('G', 150),
    refuse('G', 160, kPolar),
    tell('G', 220, "*", "forbids a space to the tool"),
    ends('G', 230),
    ends('G', 250),
    tell('G', 260, "PQR", "watches the spindle's speed"),
    refuse('G', 270, "moves to the reference position and checks it"),
    refuse('G', 290, "comes back from the reference position"),
    as('G', 310, code::g31),
    refuse('G', 440, "takes the tool's length with the other sign"),
    refuse('G', 450, 480, kShift),
    ends('G', 500, "XYZ", "S"),
    ends('G', 501, "XYZABC"),
    refuse('G', 510, kScaling),
    refuse('G', 511, kMirror),
    as('G', 541, code::g54_1),
    refuse('G', 600, "comes to each point from the same side"),
    as('G', 610, code::g61_1),
    tell('G', 620, "", "slows down at inside corners"),
    tell('G', 630, "", "keeps the override at 100 %"),
    refuse('G', 680, kTurned),
    refuse('G', 682, "tilts the working plane"),
    ends('G', 690),
    as('G', 700, code::g20, "PQUWD"),
    as('G', 710, code::g21, "PQUWD"),
    refuse('G', 720, kLathe),
    as('G', 730, code::g73, "UWPD"),
    as('G', 740, code::g74, "UWD"),
    refuse('G', 750, kLathe),
    refuse('G', 760, "fine boring on a mill, a cycle of threads on a lathe"),
    as('G', 920, code::g92, "S"),
    tell('M', 29, "", kRigid),
    refuse('M', 70, 73, "a code of the machine's builder"),
};

constexpr DialectCode kHaasCodes[] = {
    refuse('G', 50, "no code of Haas"),
    refuse('G', 70, "no code of Haas"),
    refuse('G', 80, "no code of Haas"),
    tell('G', 90, "", "stops exactly at the end of its line"),
    refuse('G', 120, "cuts a round pocket"),
    refuse('G', 130, "cuts a round pocket"),
    refuse('G', 290, "comes back from the reference position"),
    as('G', 310, code::g31),
    refuse('G', 350, 370, "measures a tool"),
    refuse('G', 440, "takes the tool's length with the other sign"),
    refuse('G', 470, "engraves a text"),
    ends('G', 500, "", "S"),
    refuse('G', 510, kScaling),
    as('G', 541, code::g54_1),
    refuse('G', 600, "comes to each point from the same side"),
    as('G', 610, code::g61_1),
    refuse('G', 680, kTurned),
    ends('G', 690),
    refuse('G', 700, 720, "a pattern of holes on a mill, a cycle on a lathe"),
    as('G', 730, code::g73, "UW"),
    as('G', 740, code::g74, "UW"),
    refuse('G', 750, kLathe),
    refuse('G', 760, kBoring),
    refuse('G', 770, "back boring"),
    as('G', 920, code::g92, "S"),
    ends('G', 1000, "XYZAB"),
    refuse('G', 1010, kMirror),
    tell('G', 1020, "*", "writes a line to the serial port"),
    tell('G', 1030, "P", kLookAhead),
    refuse('G', 1070, "winds the path round a cylinder"),
    further_system(1100, 1),
    further_system(1110, 2),
    further_system(1120, 3),
    further_system(1130, 4),
    further_system(1140, 5),
    further_system(1150, 6),
    further_system(1160, 7),
    further_system(1170, 8),
    further_system(1180, 9),
    further_system(1190, 10),
    further_system(1200, 11),
    further_system(1210, 12),
    further_system(1220, 13),
    further_system(1230, 14),
    further_system(1240, 15),
    further_system(1250, 16),
    further_system(1260, 17),
    further_system(1270, 18),
    further_system(1280, 19),
    further_system(1290, 20),
    refuse('G', 1360, "measures a work offset"),
    refuse('G', 1410, "compensates the radius in space"),
    refuse('G', 1430, "keeps the point of the tool"),
    refuse('G', 1500, "mills a pocket"),
    as('G', 1540, code::g54_1),
    refuse('G', 1740, "a rigid tap that does not stand upright"),
    refuse('G', 1840, "a rigid tap that does not stand upright"),
    tell('G', 1870, "PE", "chooses smoothness and rounding of corners"),
    refuse('G', 2340, "keeps the point of the tool"),
    refuse('G', 2540, "moves the work offset with the table"),
    ends('G', 2550),
    tell('M', 10, 13, "", "clamps and releases a rotary axis"),
    as('M', 16, code::m6),
    tell('M', 21, 28, "", "switches an output and waits for the machine"),
    tell('M', 29, "", kRigid),
    tell('M', 31, "", "drives the chip conveyor"),
    tell('M', 33, "", "stops the chip conveyor"),
    tell('M', 34, 35, "", "moves the coolant spigot"),
    refuse('M', 36, "waits for a part"),
    refuse('M', 39, "turns the tool carousel"),
    tell('M', 41, 42, "", "changes the spindle's gear"),
    tell('M', 46, "", "asks whether a pallet is loaded"),
    refuse('M', 48, "checks the program"),
    refuse('M', 49, "no code of Haas"),
    refuse('M', 50, "changes the pallet"),
    tell('M', 51, 58, "", "switches an output of the machine"),
    tell('M', 59, "P", "switches an output of the machine"),
    tell('M', 61, 68, "", "switches an output of the machine"),
    tell('M', 69, "P", "switches an output of the machine"),
    refuse('M', 70, 72, "no code of Haas"),
    tell('M', 73, 74, "", "blows air at the tool"),
    tell('M', 75, 79, "", "says what follows a skip"),
    tell('M', 80, 81, "", "opens and closes the door"),
    tell('M', 83, 84, "", "switches the air gun"),
    tell('M', 88, 89, "", "switches the coolant through the spindle"),
    tell('M', 104, 105, "", "swings the probe's arm"),
    refuse('M', 109, "asks the operator"),
    tell('M', 130, 131, "", "shows a picture"),
    tell('M', 138, 139, "PE", "varies the spindle's speed"),
};

constexpr std::string_view kHeater = "heats; kadr has no heater";
constexpr std::string_view kFan = "drives a fan; kadr has none";
constexpr std::string_view kFilament = "concerns the filament; kadr has no extruder";
constexpr std::string_view kSettings = "sets the firmware: limits and motors are those of the machine file";
constexpr std::string_view kReport = "reports to the host";

constexpr DialectCode kPrinterCodes[] = {
    refuse('G', 70, "no code of printers"),
    refuse('G', 80, "no code of printers"),
    tell('G', 100, 110, "*", kFilament),
    refuse('G', 120, "cleans the nozzle"),
    refuse('G', 260, "prints a pattern to check the mesh"),
    refuse('G', 270, "parks the tool"),
    tell('G', 290, "*", "probes the bed: the one of kadr is level"),
    refuse('G', 300, "probes the bed at one point"),
    tell('M', 16, 18, "*", "switches motors"),
    tell('M', 20, 29, "*", "reads and writes the card"),
    tell('M', 31, 36, "*", kReport),
    tell('M', 42, "*", "switches a pin"),
    tell('M', 73, "*", "shows the progress"),
    tell('M', 75, 78, "*", "counts the time of the print"),
    tell('M', 80, 81, "*", "switches the supply"),
    tell('M', 82, 83, "*", kFilament),
    tell('M', 84, 85, "*", "switches motors"),
    tell('M', 92, "*", kSettings),
    tell('M', 104, "*", kHeater),
    tell('M', 105, "*", kReport),
    tell('M', 106, 107, "*", kFan),
    tell('M', 109, "*", kHeater),
    tell('M', 110, "*", "numbers the lines"),
    tell('M', 111, "*", kReport),
    refuse('M', 112, "stops at once, as an emergency"),
    tell('M', 113, 116, "*", kReport),
    tell('M', 117, 118, "*", "shows a text"),
    tell('M', 119, "*", kReport),
    tell('M', 140, 141, "*", kHeater),
    tell('M', 145, "*", kHeater),
    tell('M', 149, "*", kHeater),
    tell('M', 150, "*", "lights a lamp"),
    tell('M', 154, 155, "*", kReport),
    tell('M', 190, 191, "*", kHeater),
    tell('M', 200, "*", kFilament),
    tell('M', 201, 206, "*", kSettings),
    tell('M', 207, 209, "*", kFilament),
    tell('M', 211, "*", kSettings),
    tell('M', 220, "*", "scales the feed: the override of kadr is the operator's"),
    tell('M', 221, "*", kFilament),
    tell('M', 226, "*", "waits for a pin"),
    tell('M', 280, 282, "*", "turns a servo"),
    tell('M', 290, "*", kSettings),
    tell('M', 300, "*", "beeps"),
    tell('M', 301, 304, "*", kHeater),
    tell('M', 355, "*", "lights a lamp"),
    tell('M', 400, "*", "waits until the tool stands"),
    tell('M', 401, 402, "*", "moves the probe's arm"),
    tell('M', 403, 407, "*", kFilament),
    tell('M', 412, "*", kFilament),
    tell('M', 413, "*", kSettings),
    tell('M', 420, 421, "*", "levels the bed: the one of kadr is level"),
    tell('M', 425, "*", kSettings),
    tell('M', 486, "*", "names an object"),
    tell('M', 500, 504, "*", kSettings),
    tell('M', 566, 569, "*", kSettings),
    tell('M', 572, "*", kFilament),
    tell('M', 575, "*", kReport),
    tell('M', 593, "*", kSettings),
    refuse('M', 600, "changes the filament, with moves of its own"),
    tell('M', 851, "*", kSettings),
    tell('M', 862, "*", kReport),
    tell('M', 900, "*", kFilament),
    tell('M', 905, 928, "*", kSettings),
};

std::span<const DialectCode> codes_of(Dialect dialect) {
  switch (dialect) {
    case Dialect::linuxcnc:
    case Dialect::grbl:
      return {};
    case Dialect::mach3:
      return kMach3Codes;
    case Dialect::marlin:
    case Dialect::reprap:
      return kPrinterCodes;
    case Dialect::fanuc:
      return kFanucCodes;
    case Dialect::haas:
      return kHaasCodes;
  }
  return {};
}

/// Of Grbl 1.1: gc_execute_line() in gcode.c answers all others with error 20.
constexpr int kGrblG[] = {
    code::g0,    code::g1,    code::g2,    code::g3,    code::g4,    code::g10, code::g17,   code::g18,
    code::g19,   code::g20,   code::g21,   code::g28,   code::g28_1, code::g30, code::g30_1, code::g38_2,
    code::g38_3, code::g38_4, code::g38_5, code::g40,   code::g43_1, code::g49, code::g53,   code::g54,
    code::g55,   code::g56,   code::g57,   code::g58,   code::g59,   code::g61, code::g80,   code::g90,
    code::g91,   code::g91_1, code::g92,   code::g92_1, code::g93,   code::g94};
constexpr int kGrblM[] = {code::m0, code::m1, code::m2, code::m3, code::m4,
                          code::m5, code::m7, code::m8, code::m9, code::m30};

}  // namespace

const DialectCode* dialect_code(Dialect dialect, char letter, int number) {
  for (const DialectCode& row : codes_of(dialect))
    if (row.letter == letter && row.first <= number && number <= row.last) return &row;
  return nullptr;
}

bool has_code(Dialect dialect, char letter, int number) {
  if (dialect != Dialect::grbl) return true;
  const auto listed = [number](const auto& list) {
    return std::find(std::begin(list), std::end(list), number) != std::end(list);
  };
  return letter == 'G' ? listed(kGrblG) : listed(kGrblM);
}

GCode code_of_dialects(int tenths) {
  if (tenths == code::g31) return {Standing::runs, GGroup::motion};
  if (tenths == code::g54_1) return {Standing::runs, GGroup::coordinate_system};
  return {};
}

}  // namespace kadr::gcode
