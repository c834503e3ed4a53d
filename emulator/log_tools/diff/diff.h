#pragma once
#include "emulator/log_tools/diff/diff_report.h"
#include "emulator/log_tools/diff/log_diff.h"
#include "emulator/log_tools/diff/path_diff.h"

/// Two logs side by side: by control tick (log_diff.h) or by path length
/// (path_diff.h), rendered by diff_report.h (docs/diff.md).
