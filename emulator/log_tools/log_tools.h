#pragma once
#include "emulator/log_tools/diff/diff.h"
#include "emulator/log_tools/export/export.h"
#include "emulator/log_tools/report/report.h"

/// Tools that only read logs: diff/ compares two, export/ writes them in the forms of other tools,
/// report/ makes pages. No engine is linked: a program that only looks at logs needs log/ and this.
