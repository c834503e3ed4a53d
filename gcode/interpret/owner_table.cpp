#include <fmt/format.h>

#include <algorithm>

#include "gcode/dialect/codes.h"
#include "gcode/dialect/dialect_codes.h"
#include "gcode/interpret/owner_codes.h"

namespace kadr::gcode {
namespace {

bool is_run(Dialect dialect, const machine::CodeName& code) {
  if (const DialectCode* row = dialect_code(dialect, code.letter, code.number))
    return row->reading == CodeReading::runs || row->reading == CodeReading::ends_nothing;
  return (code.letter == 'G' ? g_code(code.number).standing : m_code(code.number).standing) == Standing::runs;
}

/// True for M codes behind which the machine may stand for a while.
bool takes_time(const machine::CodeName& code) {
  if (code.letter != 'M') return false;
  const MCode known = m_code(code.number);
  return known.standing == Standing::runs &&
         (known.group == MGroup::spindle || known.group == MGroup::coolant);
}

}  // namespace

OwnerTable::OwnerTable(const machine::OwnerCodes& codes, const std::vector<machine::CodeName>& ignored) {
  for (const machine::CodeName& code : codes.ignore) entries_.push_back({code, nullptr});
  for (const machine::OwnerCode& own : codes.own) entries_.push_back({own.code, &own});
  for (const machine::CodeName& code : ignored) entries_.push_back({code, nullptr});
}

const OwnerTable::Entry* OwnerTable::find(char letter, int number) const {
  for (const Entry& entry : entries_) {
    if (entry.code.letter != letter || entry.code.number != number) continue;
    const bool only_time = entry.own != nullptr && entry.own->call.empty() && takes_time(entry.code);
    return only_time ? nullptr : &entry;
  }
  return nullptr;
}

double OwnerTable::time_s(int number) const {
  for (const Entry& entry : entries_)
    if (entry.own != nullptr && entry.code.letter == 'M' && entry.code.number == number)
      return entry.own->time_s;
  return 0;
}

void OwnerTable::check(Dialect dialect, Report& report) const {
  std::string options;  // codes of the command line have no place: one message for all of them
  for (const Entry& entry : entries_) {
    if (!is_run(dialect, entry.code)) continue;
    const machine::OwnerCode* own = entry.own;
    const bool tool_change = entry.code.letter == 'M' && entry.code.number == code::m6;
    const bool calls = own != nullptr && !own->call.empty();
    const bool only_time = own != nullptr && !calls && own->output < 0 && own->stop;
    if (only_time && takes_time(entry.code)) continue;
    if (calls && tool_change) continue;
    if (entry.code.span.line == 0) {
      options += (options.empty() ? "" : ", ") + machine::code_text(entry.code);
      continue;
    }
    report.error(problem(Code::owner_code_taken, entry.code.span,
                         fmt::format("kadr runs {} itself", machine::code_text(entry.code)),
                         own == nullptr ? "leave it out of the list"
                                        : "of M3 to M9 and M19 give time_s alone; M6 may call a subroutine"));
  }
  if (options.empty()) return;
  Diagnostic d = problem(Code::owner_code_taken, {}, {}, "leave it out of --ignore");
  d.message = fmt::format("{}: kadr runs {}", d.message, options);
  report.error(std::move(d));
}

}  // namespace kadr::gcode
