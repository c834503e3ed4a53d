#include "gcode/codes.h"

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
                            {800, GGroup::motion},
                            {40, GGroup::nonmodal},
                            {100, GGroup::nonmodal},
                            {280, GGroup::nonmodal},
                            {281, GGroup::nonmodal},
                            {300, GGroup::nonmodal},
                            {301, GGroup::nonmodal},
                            {530, GGroup::nonmodal},
                            {920, GGroup::nonmodal},
                            {921, GGroup::nonmodal},
                            {922, GGroup::nonmodal},
                            {923, GGroup::nonmodal},
                            {170, GGroup::plane},
                            {180, GGroup::plane},
                            {190, GGroup::plane},
                            {200, GGroup::units},
                            {210, GGroup::units},
                            {400, GGroup::compensation},
                            {430, GGroup::tool_length},
                            {431, GGroup::tool_length},
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
                            {940, GGroup::feed_mode}};

constexpr int kKnownG[] = {50,  51,  52,  53,  70,  80,  171, 181, 191, 330, 331, 332, 382, 383, 384, 385,
                           410, 411, 420, 421, 432, 500, 510, 520, 700, 710, 711, 712, 720, 721, 722, 730,
                           740, 760, 810, 820, 830, 840, 850, 860, 870, 880, 890, 950, 960, 970, 980, 990};

struct MEntry {
  int number;
  MGroup group;
};
constexpr MEntry kRunM[] = {
    {0, MGroup::stop},       {1, MGroup::stop},        {2, MGroup::stop},       {30, MGroup::stop},
    {60, MGroup::stop},      {6, MGroup::tool_change}, {3, MGroup::spindle},    {4, MGroup::spindle},
    {5, MGroup::spindle},    {7, MGroup::coolant},     {8, MGroup::coolant},    {9, MGroup::coolant},
    {48, MGroup::overrides}, {49, MGroup::overrides},  {50, MGroup::overrides}, {51, MGroup::overrides}};
constexpr int kKnownM[] = {19, 52, 53, 61, 62, 63, 64, 65, 66, 67, 68, 70, 71, 72, 73, 98, 99};
constexpr int kFirstUserM = 100;  // M100 .. M199 are the user's own

constexpr std::array<GCode, kGTableSize> make_g_table() {
  std::array<GCode, kGTableSize> table{};
  for (const int tenths : kKnownG) table[static_cast<std::size_t>(tenths)].standing = Standing::not_run;
  for (const GEntry& e : kRunG) table[static_cast<std::size_t>(e.tenths)] = {Standing::runs, e.group};
  return table;
}
constexpr std::array<MCode, kMTableSize> make_m_table() {
  std::array<MCode, kMTableSize> table{};
  for (const int number : kKnownM) table[static_cast<std::size_t>(number)].standing = Standing::not_run;
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
  return tenths == 100 || tenths == 280 || tenths == 300 || tenths == 431 || tenths == 920;
}

}  // namespace kadr::gcode
