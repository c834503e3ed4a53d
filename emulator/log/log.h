#pragma once
#include "emulator/log/log_info.h"
#include "emulator/log/log_reader.h"
#include "emulator/log/records.h"
#include "emulator/log/run_log.h"

/// The log of a run: records.h says what is in it, a RunLog takes the records (run_log.h: an LCM event log),
/// LogReader gives them back, log_info() looks at a whole file. Records are plain numbers and texts: nothing
/// here knows how they came about (docs/log_format.md).
