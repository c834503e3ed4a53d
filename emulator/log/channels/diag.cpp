#include "emulator/log/channels/diag.h"

namespace kadr::log {

LogDiagnostic log_diagnostic(const Diagnostic& d, Ticks tick) {
  return {tick, d.severity, code_name(d.code), d.span, d.message, d.label, d.notes, d.help};
}

}  // namespace kadr::log
