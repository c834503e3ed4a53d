#pragma once
#include <cstdint>
#include <limits>
#include <string>

/// Options of exports and plots; in a header of their own, so that the command line needs no more.
namespace kadr::log_tools {

/// Selection from a log.
struct SampleChoice {
  std::string signals;  ///< comma-separated, `*` matches any text: "feed.*,axis.X.load_mm"; empty: all
  double from_s = 0;
  double to_s = std::numeric_limits<double>::infinity();
  /// every n-th control tick, n = round(control rate / rate_hz), at least 1; 0: every one
  double rate_hz = 0;
};

enum class CsvForm : std::uint8_t {
  plain,  ///< comma, decimal point
  excel,  ///< semicolon, decimal comma and a byte order mark: spreadsheets of a locale with decimal comma
};

/// Options of a plot in the terminal.
struct PlotForm {
  int width = 80;      ///< cells, with the axis
  int height = 0;      ///< cells of each picture, of a path at most; 0: 10, of a path 20
  bool ascii = false;  ///< `#` instead of Braille dots
};

}  // namespace kadr::log_tools
