#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "emulator/studies/time_law/law_study.h"

namespace kadr::studies {

/// The laws of a problem as one HTML file without script: the speed along the path pass by pass with the
/// tube's edges and caps, a close-up of the last passes, the speed of every method over time, each
/// with its numbers in a table. No wall clock, so equal runs give equal bytes.
/// @param study  with the profiles of the tube, if it was asked for
/// @param file   of the problem, for the headline
std::string render_tube_page(const LawStudy& study, const TimeLawProblem& problem, std::string_view file);

/// Begins such a page, up to and with <body>.
std::string law_page_head(std::string_view title);
/// A table of it; the first row is its head.
std::string law_page_table(const std::string& caption, const std::vector<std::vector<std::string>>& rows);

}  // namespace kadr::studies
