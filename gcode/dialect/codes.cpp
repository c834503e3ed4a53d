#include "gcode/dialect/codes.h"

#include <array>
#include <cstddef>
#include <iterator>

namespace kadr::gcode {
namespace {

constexpr int kGTableSize = 1000;  // G0 .. G99.9
constexpr int kMTableSize = 200;

struct GEntry {
  int tenths;
  GGroup group;
};
constexpr GEntry kRunG[] = {{code::g0, GGroup::motion},
                            {code::g1, GGroup::motion},
                            {code::g2, GGroup::motion},
                            {code::g3, GGroup::motion},
                            {code::g5, GGroup::motion},
                            {code::g5_1, GGroup::motion},
                            {code::g5_2, GGroup::motion},
                            {code::g5_3, GGroup::motion},
                            {code::g33, GGroup::motion},
                            {code::g33_1, GGroup::motion},
                            {code::g38_2, GGroup::motion},
                            {code::g38_3, GGroup::motion},
                            {code::g38_4, GGroup::motion},
                            {code::g38_5, GGroup::motion},
                            {code::g73, GGroup::motion},
                            {code::g74, GGroup::motion},
                            {code::g76, GGroup::motion},
                            {code::g80, GGroup::motion},
                            {code::g81, GGroup::motion},
                            {code::g82, GGroup::motion},
                            {code::g83, GGroup::motion},
                            {code::g84, GGroup::motion},
                            {code::g85, GGroup::motion},
                            {code::g86, GGroup::motion},
                            {code::g89, GGroup::motion},
                            {code::g4, GGroup::nonmodal},
                            {code::g10, GGroup::nonmodal},
                            {code::g28, GGroup::nonmodal},
                            {code::g28_1, GGroup::nonmodal},
                            {code::g30, GGroup::nonmodal},
                            {code::g30_1, GGroup::nonmodal},
                            {code::g52, GGroup::nonmodal},
                            {code::g53, GGroup::nonmodal},
                            {code::g92, GGroup::nonmodal},
                            {code::g92_1, GGroup::g92_state},
                            {code::g92_2, GGroup::g92_state},
                            {code::g92_3, GGroup::g92_state},
                            {code::g17, GGroup::plane},
                            {code::g18, GGroup::plane},
                            {code::g19, GGroup::plane},
                            {code::g20, GGroup::units},
                            {code::g21, GGroup::units},
                            {code::g40, GGroup::compensation},
                            {code::g41, GGroup::compensation},
                            {code::g41_1, GGroup::compensation},
                            {code::g42, GGroup::compensation},
                            {code::g42_1, GGroup::compensation},
                            {code::g43, GGroup::tool_length},
                            {code::g43_1, GGroup::tool_length},
                            {code::g43_2, GGroup::tool_length},
                            {code::g49, GGroup::tool_length},
                            {code::g54, GGroup::coordinate_system},
                            {code::g55, GGroup::coordinate_system},
                            {code::g56, GGroup::coordinate_system},
                            {code::g57, GGroup::coordinate_system},
                            {code::g58, GGroup::coordinate_system},
                            {code::g59, GGroup::coordinate_system},
                            {code::g59_1, GGroup::coordinate_system},
                            {code::g59_2, GGroup::coordinate_system},
                            {code::g59_3, GGroup::coordinate_system},
                            {code::g61, GGroup::path},
                            {code::g61_1, GGroup::path},
                            {code::g64, GGroup::path},
                            {code::g90, GGroup::distance},
                            {code::g91, GGroup::distance},
                            {code::g90_1, GGroup::arc_distance},
                            {code::g91_1, GGroup::arc_distance},
                            {code::g93, GGroup::feed_mode},
                            {code::g94, GGroup::feed_mode},
                            {code::g95, GGroup::feed_mode},
                            {code::g96, GGroup::spindle_mode},
                            {code::g97, GGroup::spindle_mode},
                            {code::g98, GGroup::retract},
                            {code::g99, GGroup::retract},
                            {code::g7, GGroup::diameter},
                            {code::g8, GGroup::diameter}};

constexpr int kKnownG[] = {171, 181, 191, 332, 500, 510, 700, 710, 711, 712, 720, 721, 722, 870, 880};

struct MEntry {
  int number;
  MGroup group;
};
constexpr MEntry kRunM[] = {
    {code::m0, MGroup::stop},         {code::m1, MGroup::stop},         {code::m2, MGroup::stop},
    {code::m30, MGroup::stop},        {code::m60, MGroup::stop},        {code::m6, MGroup::tool_change},
    {code::m61, MGroup::tool_change}, {code::m3, MGroup::spindle},      {code::m4, MGroup::spindle},
    {code::m5, MGroup::spindle},      {code::m19, MGroup::spindle},     {code::m52, MGroup::overrides},
    {code::m7, MGroup::coolant},      {code::m8, MGroup::coolant},      {code::m9, MGroup::coolant},
    {code::m48, MGroup::overrides},   {code::m49, MGroup::overrides},   {code::m50, MGroup::overrides},
    {code::m51, MGroup::overrides},   {code::m53, MGroup::overrides},   {code::m62, MGroup::inputs},
    {code::m63, MGroup::inputs},      {code::m64, MGroup::inputs},      {code::m65, MGroup::inputs},
    {code::m66, MGroup::inputs},      {code::m67, MGroup::inputs},      {code::m68, MGroup::inputs},
    {code::m70, MGroup::modal_state}, {code::m71, MGroup::modal_state}, {code::m72, MGroup::modal_state},
    {code::m73, MGroup::modal_state}, {code::m98, MGroup::call},        {code::m99, MGroup::call}};
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
/// Each code of the group `inputs` except M66 names the output it switches, and vice versa.
constexpr bool outputs_complete() {
  std::size_t outputs = 0;
  for (const MEntry& e : kRunM) {
    if (e.group != MGroup::inputs || e.number == code::m66) continue;
    std::size_t named = 0;
    for (const OutputCode& output : kOutputCodes) named += output.number == e.number ? 1 : 0;
    if (named != 1) return false;
    ++outputs;
  }
  return outputs == std::size(kOutputCodes);
}
static_assert(outputs_complete(), "kOutputCodes (codes.h) has one line per output code of kRunM");

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
  return tenths == code::g10 || tenths == code::g28 || tenths == code::g30 || tenths == code::g52 ||
         tenths == code::g92;
}

const OutputCode* output_code(int number) {
  for (const OutputCode& output : kOutputCodes)
    if (output.number == number) return &output;
  return nullptr;
}

}  // namespace kadr::gcode
