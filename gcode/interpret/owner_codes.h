#pragma once
#include <string>
#include <vector>

#include "gcode/dialect/dialect.h"
#include "gcode/read/report.h"
#include "machine/owner_codes.h"

namespace kadr::gcode {

/// The codes of the machine's owner, looked up by the words of each line: those of the machine file, and those that the
/// command line or a scenario passes over besides.
class OwnerTable {
 public:
  struct Entry {
    machine::CodeName code;
    const machine::OwnerCode* own = nullptr;  ///< null: passed over
  };

  OwnerTable(const machine::OwnerCodes& codes, const std::vector<machine::CodeName>& ignored);
  /// The entry of a code that kadr does not run itself, or that calls a subroutine; null: none.
  const Entry* find(char letter, int number) const;
  /// The time that an M code takes which kadr runs itself; 0: none.
  double time_s(int number) const;
  bool empty() const { return entries_.empty(); }
  /// Reports the entries of codes that the dialect runs, where these can't have one.
  void check(Dialect dialect, Report& report) const;

 private:
  std::vector<Entry> entries_;
};

}  // namespace kadr::gcode
