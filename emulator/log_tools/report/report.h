#pragma once
#include "emulator/log_tools/report/compare.h"
#include "emulator/log_tools/report/report_page.h"

/// Pages from logs: one run (report_page.h), several on each other (compare.h); docs/report.md.
