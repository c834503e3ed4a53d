#pragma once
#include <memory>

#include "emulator/log/run_log.h"

namespace kadr::cycle {

/// A RunLog that hands its records, in order, to `inner` on a second thread. Records are copied into a ring
/// of blocks whose storage is reused; the bytes that `inner` writes are the same as without the thread. An
/// error of `inner` comes back at one of the next calls, at end() at the latest.
std::unique_ptr<log::RunLog> make_threaded_log(log::RunLog& inner);

}  // namespace kadr::cycle
