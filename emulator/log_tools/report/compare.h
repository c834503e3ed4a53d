#pragma once
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log_tools/report/page_data.h"
#include "emulator/text/json.h"

/// `kadr compare`: runs of one program side by side.
namespace kadr::log_tools {

struct ComparedRun {
  std::string path;
  PageData data;
};

/// One quantity of every run; not-a-number where a run lacks it.
struct ComparedQuantity {
  std::string name;  ///< "vibration X, peak"
  std::string key;   ///< "vibration_X_um"
  std::string unit;
  int decimals = 3;
  std::vector<double> value;  ///< [runs]
};

/// Time, what it went into, feed, path error, vibration, following error and work of every run.
std::vector<ComparedQuantity> compared_quantities(const std::vector<ComparedRun>& runs);

/// Inputs that differ between runs: program, machine; empty: all the same.
std::string compared_note(const std::vector<ComparedRun>& runs);

std::string render_comparison(const std::vector<ComparedRun>& runs);
text::Json json_of(const std::vector<ComparedRun>& runs);
/// One HTML page: the table, and charts of all runs over time or path with one window and cursor. In a build
/// without the interactive page, and without script: feed over time, feed and path error over the path.
/// @param max_bytes  the page's size; longer runs are shown by extremes of several control ticks
std::string render_compare_page(std::vector<ComparedRun> runs, std::size_t max_bytes);

}  // namespace kadr::log_tools
