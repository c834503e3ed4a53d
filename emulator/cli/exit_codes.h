#pragma once
#include <array>
#include <string_view>

namespace kadr::cli {

inline constexpr int kYes = 0;  ///< done, the answer is yes
inline constexpr int kNo = 1;   ///< done, the answer is no: the program has errors, warnings under --strict
inline constexpr int kNotStarted = 2;  ///< usage, unreadable file, bad machine file, disk full
inline constexpr int kAlarm = 3;       ///< the run ended with alarms or a numerical fault
inline constexpr int kInternal = 70;   ///< a fault of kadr
inline constexpr int kSignal = 128;    ///< plus the number of the signal that ended the run

/// For `--help` and the manual page.
struct ExitCode {
  std::string_view code;
  std::string_view meaning;
};
inline constexpr std::array<ExitCode, 6> kExitCodes{{
    {"0", "yes"},
    {"1", "no (the program has errors)"},
    {"2", "could not start (usage, unreadable or bad file)"},
    {"3", "the run ended with an alarm"},
    {"70", "a fault of kadr"},
    {"130 and 143", "stopped by a signal"},
}};

}  // namespace kadr::cli
