#include "gcode/dialect/codes.h"

#include <array>
#include <cstddef>

namespace kadr::gcode {
namespace {

constexpr int kGTableSize = 1000;  // G0 .. G99.9
constexpr int kMTableSize = 200;

struct GEntry {
  int tenths;
  GGroup group;
};
constexpr GEntry kRunG[] = {{0, GGroup::motion},
                            {10, GGroup::motion},
                            {20, GGroup::motion},
                            {30, GGroup::motion},
                            {50, GGroup::motion},
                            {51, GGroup::motion},
                            {52, GGroup::motion},
                            {53, GGroup::motion},
                            {330, GGroup::motion},
                            {331, GGroup::motion},
                            {382, GGroup::motion},
                            {383, GGroup::motion},
                            {384, GGroup::motion},
                            {385, GGroup::motion},
                            {730, GGroup::motion},
                            {740, GGroup::motion},
                            {760, GGroup::motion},
                            {800, GGroup::motion},
                            {810, GGroup::motion},
                            {820, GGroup::motion},
                            {830, GGroup::motion},
                            {840, GGroup::motion},
                            {850, GGroup::motion},
                            {860, GGroup::motion},
                            {890, GGroup::motion},
                            {40, GGroup::nonmodal},
                            {100, GGroup::nonmodal},
                            {280, GGroup::nonmodal},
                            {281, GGroup::nonmodal},
                            {300, GGroup::nonmodal},
                            {301, GGroup::nonmodal},
                            {520, GGroup::nonmodal},
                            {530, GGroup::nonmodal},
                            {920, GGroup::nonmodal},
                            {921, GGroup::g92_state},
                            {922, GGroup::g92_state},
                            {923, GGroup::g92_state},
                            {170, GGroup::plane},
                            {180, GGroup::plane},
                            {190, GGroup::plane},
                            {200, GGroup::units},
                            {210, GGroup::units},
                            {400, GGroup::compensation},
                            {410, GGroup::compensation},
                            {411, GGroup::compensation},
                            {420, GGroup::compensation},
                            {421, GGroup::compensation},
                            {430, GGroup::tool_length},
                            {431, GGroup::tool_length},
                            {432, GGroup::tool_length},
                            {490, GGroup::tool_length},
                            {540, GGroup::coordinate_system},
                            {550, GGroup::coordinate_system},
                            {560, GGroup::coordinate_system},
                            {570, GGroup::coordinate_system},
                            {580, GGroup::coordinate_system},
                            {590, GGroup::coordinate_system},
                            {591, GGroup::coordinate_system},
                            {592, GGroup::coordinate_system},
                            {593, GGroup::coordinate_system},
                            {610, GGroup::path},
                            {611, GGroup::path},
                            {640, GGroup::path},
                            {900, GGroup::distance},
                            {910, GGroup::distance},
                            {901, GGroup::arc_distance},
                            {911, GGroup::arc_distance},
                            {930, GGroup::feed_mode},
                            {940, GGroup::feed_mode},
                            {950, GGroup::feed_mode},
                            {960, GGroup::spindle_mode},
                            {970, GGroup::spindle_mode},
                            {980, GGroup::retract},
                            {990, GGroup::retract},
                            {70, GGroup::diameter},
                            {80, GGroup::diameter}};

constexpr int kKnownG[] = {171, 181, 191, 332, 500, 510, 700, 710, 711, 712, 720, 721, 722, 870, 880};

struct MEntry {
  int number;
  MGroup group;
};
constexpr MEntry kRunM[] = {{0, MGroup::stop},         {1, MGroup::stop},         {2, MGroup::stop},
                            {30, MGroup::stop},        {60, MGroup::stop},        {6, MGroup::tool_change},
                            {61, MGroup::tool_change}, {3, MGroup::spindle},      {4, MGroup::spindle},
                            {5, MGroup::spindle},      {19, MGroup::spindle},     {52, MGroup::overrides},
                            {7, MGroup::coolant},      {8, MGroup::coolant},      {9, MGroup::coolant},
                            {48, MGroup::overrides},   {49, MGroup::overrides},   {50, MGroup::overrides},
                            {51, MGroup::overrides},   {53, MGroup::overrides},   {62, MGroup::inputs},
                            {63, MGroup::inputs},      {64, MGroup::inputs},      {65, MGroup::inputs},
                            {66, MGroup::inputs},      {67, MGroup::inputs},      {68, MGroup::inputs},
                            {70, MGroup::modal_state}, {71, MGroup::modal_state}, {72, MGroup::modal_state},
                            {73, MGroup::modal_state}, {98, MGroup::call},        {99, MGroup::call}};
constexpr int kFirstUserM = 100;  // M100 .. M199 are the user's own

constexpr std::array<GCode, kGTableSize> make_g_table() {
  std::array<GCode, kGTableSize> table{};
  for (const int tenths : kKnownG) table[static_cast<std::size_t>(tenths)].standing = Standing::not_run;
  for (const GEntry& e : kRunG) table[static_cast<std::size_t>(e.tenths)] = {Standing::runs, e.group};
  return table;
}
constexpr std::array<MCode, kMTableSize> make_m_table() {
  std::array<MCode, kMTableSize> table{};
  for (int m = kFirstUserM; m < kMTableSize; ++m)
    table[static_cast<std::size_t>(m)].standing = Standing::not_run;
  for (const MEntry& e : kRunM) table[static_cast<std::size_t>(e.number)] = {Standing::runs, e.group};
  return table;
}
constexpr auto kGTable = make_g_table();
constexpr auto kMTable = make_m_table();

}  // namespace

GCode g_code(int tenths) {
  return tenths >= 0 && tenths < kGTableSize ? kGTable[static_cast<std::size_t>(tenths)] : GCode{};
}

MCode m_code(int number) {
  return number >= 0 && number < kMTableSize ? kMTable[static_cast<std::size_t>(number)] : MCode{};
}

bool takes_axis_words(int tenths) {
  return tenths == 100 || tenths == 280 || tenths == 300 || tenths == 520 || tenths == 920;
}

}  // namespace kadr::gcode
