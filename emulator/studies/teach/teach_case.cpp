#include "emulator/studies/teach/teach_case.h"

#include <fmt/format.h>

namespace kadr::studies {
namespace {

std::string fault_text(const CaseReading& reading) {
  const std::string_view kind = kCaseKinds.word(reading.subject.kind);
  const std::string& word = reading.word;
  switch (reading.fault) {
    case CaseFault::number:
      return fmt::format("'{}' is not a whole number of steps", word);
    case CaseFault::beyond:
      return fmt::format("'{}' is beyond {} steps", word, kMostGiven_steps);
    case CaseFault::turn:
      return fmt::format("{} takes no ccw or cw", kind);
    case CaseFault::polynomial:
      return fmt::format("'{}' can't be read from character {} on; a polynomial looks like '6400 y - x^3'",
                         word, reading.place);
    case CaseFault::degree:
      return fmt::format("'{}' is of degree {}, allowed {}", word, reading.place, kMostPolynomialDegree);
    case CaseFault::half_axes:
      return fmt::format("ellipse: half axes are 1 to {} steps", kMostHalfAxis_steps);
    case CaseFault::far_parabola:
      return fmt::format("parabola: {} is beyond 2^29 steps", word);
    case CaseFault::flat_parabola:
      return "parabola: P must not be 0";
    case CaseFault::count:
      return fmt::format("{} takes {}; got {} {}", kind, case_numbers(reading.subject.kind), reading.place,
                         reading.place == 1 ? "number" : "numbers");
    case CaseFault::kind:
      return fmt::format("a case begins with one of {}; got '{}'", kCaseKinds.list(), word);
    case CaseFault::none:
      break;
  }
  return {};
}

}  // namespace

tl::expected<TeachCase, std::string> read_teach_case(const std::vector<std::string>& words, int axes) {
  CaseReading reading = read_case(words, axes);
  if (reading.fault != CaseFault::none) return tl::unexpected(fault_text(reading));
  return std::move(reading.subject);
}

}  // namespace kadr::studies
