#pragma once
#include <functional>
#include <string>

#include "gcode/block.h"
#include "machine/base/diagnostic.h"

/// The G-code front end: text -> parse tree (what was written, with spans) -> Blocks (what it means).
/// Dialect: RS-274/NGC. Every mistake of a program is told in one run; an unknown word is never skipped.
namespace kadr::gcode {

struct InterpretOptions {
  std::string axis_letters = "XYZABCUVW";  ///< axes of the machine; a word of another axis is an error
  AxisValues home{};                       ///< machine position at start, mm and deg
  AxisValues g28{};                        ///< G28 reference point, machine coordinates
  AxisValues g30{};                        ///< G30 reference point, machine coordinates
  double arc_end_tolerance_mm = 0.01;      ///< docs: PathLimits
  double arc_end_tolerance_relative = 0.001;
  bool block_delete = false;     ///< leave out lines that begin with '/'
  std::uint32_t max_blocks = 0;  ///< 0: no bound
};

/// Reads and interprets sources[file], handing each Block to `sink` in program order. Streaming: memory does
/// not grow with the program. After the first error blocks are still made where possible, so that later
/// mistakes are told too; the caller moves nothing if diagnostics.has_errors(). The file that ends without
/// M2/M30/% still gets a program_end block.
void interpret(const SourceSet& sources, std::uint32_t file, const InterpretOptions& options,
               const std::function<void(const Block&)>& sink, Diagnostics& diagnostics);

/// One line of the canonical trace for a block (without line end), e.g.
/// "STRAIGHT_FEED 10.000000 0.000000 ... @12"; empty if the block is not part of the trace.
void append_canon(std::string& out, const Block& block);

}  // namespace kadr::gcode
