#pragma once
#include <string>

#include "machine/infinity.h"
#include "tests/storm/invariants.h"

namespace kadr::storm {

/// Where the program kadr runs a case, and with what.
struct WorldOptions {
  std::string folder;         ///< of the case
  std::string scratch;        ///< of outputs
  std::string program;        ///< path of kadr
  std::string failing_calls;  ///< path of the library for LD_PRELOAD; empty: no call fails
  std::string library_log;    ///< the log that the library wrote of the case; empty: none to compare
  double until_s = machine::kInfinity;
};

/// Runs `kadr run -s FOLDER` alone, and again while the world does to it what fault.txt says:
///   kill SHARE         kill -9, after that share of the time that it takes alone
///   signal N SHARE     SIGINT or SIGTERM then
///   fsize SHARE        files are bounded to that share of the whole log
///   closed MASK        of descriptors 0, 1 and 2 those whose bit is set are closed
///   change replaced|cut   the program is replaced, or cut and written again, all the time
///   race               two runs with one -o
///   call KIND N        the n-th call of a kind fails (tests/faults/failing_calls)
/// Looks at exit codes, the output, and the inputs.
Verdict check_world(const StormCase& storm_case, const WorldOptions& options);

}  // namespace kadr::storm
