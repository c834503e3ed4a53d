#include "gcode/gcode.h"

#include "gcode/interpreter.h"
#include "gcode/program.h"

namespace kadr::gcode {

void interpret(SourceSet& sources, std::uint32_t file, const InterpretOptions& options,
               const std::function<void(const Block&)>& sink, Diagnostics& diagnostics) {
  Report report(diagnostics);
  Program program(sources, file, report);
  Interpreter interpreter(options, report, sink);
  Line line;
  line.file = file;
  while (!interpreter.ended() && !report.full() && program.next(line)) interpreter.run(line);
  const Span end{file, line.number > 0 ? line.number : 1, 1, 1};
  if (!report.full()) interpreter.finish(end);
  report.close(end);
}

}  // namespace kadr::gcode
