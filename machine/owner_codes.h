#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "machine/base/diagnostic.h"

/// G and M codes that belong to the machine's owner: what they do there, and which of them kadr passes over.
namespace kadr::machine {

/// A code as a program names it: M31, G12.1.
struct CodeName {
  char letter = 'M';  ///< G or M
  int number = 0;     ///< of G ten times the number
  Span span;          ///< where it is named, for messages
  bool operator==(const CodeName& other) const { return letter == other.letter && number == other.number; }
};

/// "M31", "g12.1", "M031": numbers up to 99999, of G with one decimal. Nothing for any other text.
std::optional<CodeName> parse_code_name(std::string_view text);
/// "M31", "G12.1"
std::string code_text(const CodeName& code);

/// What a code of the owner does. For a code that kadr runs itself it is the time that this takes.
struct OwnerCode {
  CodeName code;
  double time_s = 0;  ///< that the machine stands
  int output = -1;    ///< digital output that it switches; -1: none
  bool on = true;     ///< the new state of the output
  bool stop = true;   ///< the motion stops for it; otherwise the output is switched as the next motion begins
  std::string call;   ///< subroutine that runs in its place; empty: none
  bool operator==(const OwnerCode&) const = default;
};

/// The table [codes] of a machine file.
struct OwnerCodes {
  std::vector<CodeName> ignore;  ///< passed over with the words that belong to them
  std::vector<OwnerCode> own;    ///< in the order of the file
  bool operator==(const OwnerCodes&) const = default;
};

}  // namespace kadr::machine
