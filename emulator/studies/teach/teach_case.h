#pragma once
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "emulator/studies/teach/case_words.h"

/// `kadr teach`: interpolators step by step, for people who learn how they work.
namespace kadr::studies {

/// Reads the words of a case (case_words.h).
/// @param axes  of Beziers and polylines, whose words are taken in groups of this size
/// @return the case, or what is wrong with its words
tl::expected<TeachCase, std::string> read_teach_case(const std::vector<std::string>& words, int axes);

}  // namespace kadr::studies
