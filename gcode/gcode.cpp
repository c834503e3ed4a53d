#include "gcode/gcode.h"

#include "gcode/flow/flow.h"
#include "gcode/interpret/interpret.h"
#include "gcode/read/read.h"

namespace kadr::gcode {

void interpret(SourceSet& sources, std::uint32_t file, const InterpretOptions& options,
               const std::function<void(const Block&)>& sink, Diagnostics& diagnostics) {
  Report report(diagnostics);
  Interpreter interpreter(options, report, sink);
  Flow flow(sources, file, options, report, interpreter);
  interpreter.begin(sources);
  flow.run();
  flow.tell_range();
  if (flow.ran_out()) interpreter.text_ran_out(file);
  if (!report.full()) interpreter.finish(flow.end());
  report.close(flow.end());
  if (report.errors() > 0 && options.dialect == Dialect::linuxcnc && !options.dialect_said)
    suggest_dialect(sources, file, diagnostics);
}

}  // namespace kadr::gcode
