#pragma once

namespace kadr::cli {

inline constexpr int kYes = 0;  ///< done, the answer is yes
inline constexpr int kNo = 1;   ///< done, the answer is no: the program has errors, warnings under --strict
inline constexpr int kNotStarted = 2;  ///< usage, unreadable file, bad machine file, disk full
inline constexpr int kAlarm = 3;       ///< the run ended with alarms or a numerical fault
inline constexpr int kInternal = 70;   ///< our own fault
inline constexpr int kSignal = 128;    ///< plus the number of the signal that ended the run

}  // namespace kadr::cli
