#pragma once
#include "gcode/read/parser.h"
#include "gcode/read/program.h"
#include "gcode/read/report.h"
#include "gcode/read/text_resolver.h"
#include "gcode/read/tool_table.h"
#include "gcode/read/tree.h"

/// Text to tree, nothing interpreted: Parser (over the letters and numbers of scanner.h) makes lines of
/// words, comments and expressions (tree.h), each with its span. Program reads a text piece by piece,
/// a TextResolver finds the files that it calls, ToolTable is a tool.tbl. Mistakes go to a Report, and reading continues.
