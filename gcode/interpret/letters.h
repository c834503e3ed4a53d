#pragma once
#include <cstdint>
#include <string>

/// The letters that each code reads, besides axes, F, S and T. The only table: other letters are refused.
namespace kadr::gcode {

/// Letters of a G code in tenths, as bits (letter_bit in words.h); 0: none.
std::uint32_t letters_of_g(int tenths);
/// Letters of an M code.
std::uint32_t letters_of_m(int number);

/// "P belongs to G2 G3 ...": the codes that read a letter.
std::string users_of(char letter);

}  // namespace kadr::gcode
