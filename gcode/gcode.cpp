#include "gcode/gcode.h"

#include "gcode/flow/flow.h"
#include "gcode/interpret/interpret.h"
#include "gcode/read/read.h"

namespace kadr::gcode {

bool set_bound(ReadingBounds& bounds, std::string_view name, std::uint64_t value) {
  const auto narrow = [&](std::uint32_t& bound) {
    if (value > UINT32_MAX) return false;
    bound = static_cast<std::uint32_t>(value);
    return true;
  };
  const auto wide = [&](std::uint64_t& bound) {
    bound = value;
    return true;
  };
  if (name == "blocks") return wide(bounds.blocks);
  if (name == "call_depth") return narrow(bounds.call_depth);
  if (name == "loop_passes") return wide(bounds.loop_passes);
  if (name == "file_bytes") return wide(bounds.file_bytes);
  if (name == "line_bytes") return narrow(bounds.line_bytes);
  return false;
}

void interpret(SourceSet& sources, std::uint32_t file, const InterpretOptions& options,
               const std::function<void(const Block&)>& sink, Diagnostics& diagnostics) {
  Report report(diagnostics);
  Interpreter interpreter(options, report, sink);
  Flow flow(sources, file, options, report, interpreter);
  flow.run();
  if (!report.full()) interpreter.finish(flow.end());
  report.close(flow.end());
}

}  // namespace kadr::gcode
