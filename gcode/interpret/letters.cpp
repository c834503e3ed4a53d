#include "gcode/interpret/letters.h"

#include <fmt/format.h>

#include <map>
#include <string_view>

#include "gcode/dialect/codes.h"
#include "gcode/interpret/words.h"

namespace kadr::gcode {
namespace {

struct CodeLetters {
  int number;
  std::string_view letters;
};

constexpr CodeLetters kGLetters[] = {
    {code::g2, "IJKRP"},   {code::g3, "IJKRP"}, {code::g4, "P"},       {code::g5, "IJPQ"},
    {code::g5_1, "IJ"},    {code::g5_2, "PL"},  {code::g10, "LPRQIJ"}, {code::g33, "KE$"},
    {code::g33_1, "KIE$"}, {code::g41, "DL"},   {code::g41_1, "DL"},   {code::g42, "DL"},
    {code::g42_1, "DL"},   {code::g43, "H"},    {code::g43_2, "H"},    {code::g54_1, "P"},
    {code::g64, "PQ"},     {code::g73, "RLQ"},  {code::g74, "RP"},     {code::g76, "PIJRKQHEL$"},
    {code::g81, "RL"},     {code::g82, "RLP"},  {code::g83, "RLQ"},    {code::g84, "RLP"},
    {code::g85, "RL"},     {code::g86, "RLP"},  {code::g89, "RLP"},    {code::g96, "D$"},
    {code::g97, "$"}};

/// Except output codes, which have their own table (kOutputCodes).
constexpr CodeLetters kMLetters[] = {{code::m3, "$"},     {code::m4, "$"},  {code::m5, "$"},
                                     {code::m19, "RPQ$"}, {code::m50, "P"}, {code::m51, "P$"},
                                     {code::m52, "P"},    {code::m53, "P"}, {code::m61, "Q"},
                                     {code::m66, "PELQ"}, {code::m98, "PL"}};

constexpr std::string_view letters_of(const OutputCode& output) { return output.analog ? "EQ" : "P"; }

std::string names_of_readers(char letter) {
  std::string names;
  const auto add = [&](std::string_view letters, const std::string& name) {
    if (letters.find(letter) != std::string_view::npos) names += " " + name;
  };
  for (const CodeLetters& code : kGLetters) add(code.letters, g_name(code.number));
  std::map<int, std::string_view> m_letters;
  for (const CodeLetters& code : kMLetters) m_letters[code.number] = code.letters;
  for (const OutputCode& output : kOutputCodes) m_letters[output.number] = letters_of(output);
  for (const auto& [number, letters] : m_letters) add(letters, fmt::format("M{}", number));
  return names;
}

}  // namespace

std::uint32_t letters_of_g(int tenths) {
  for (const CodeLetters& code : kGLetters)
    if (code.number == tenths) return letter_bits(code.letters);
  return 0;
}

std::uint32_t letters_of_m(int number) {
  if (const OutputCode* output = output_code(number)) return letter_bits(letters_of(*output));
  for (const CodeLetters& code : kMLetters)
    if (code.number == number) return letter_bits(code.letters);
  return 0;
}

std::string users_of(char letter) {
  const std::string readers = names_of_readers(letter);
  if (readers.empty()) return "no code that kadr runs reads this letter";
  if (letter == '$') return "$ names a spindle: it belongs to S" + readers;
  return fmt::format("{} belongs to{}", letter, readers);
}

}  // namespace kadr::gcode
