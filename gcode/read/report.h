#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "gcode/dialect/dialect.h"
#include "gcode/read/tree.h"
#include "machine/base/diagnostic.h"

namespace kadr::gcode {

/// Hands mistakes of a program to the caller's list, a bounded number of them: a broken file of a million
/// lines must neither fill memory nor the screen. A line that runs many times, in a loop or a subroutine,
/// reports each of its mistakes once: for the first pass that makes it.
class Report {
 public:
  static constexpr std::size_t kMaxErrors = 1000;
  static constexpr std::size_t kMaxWarnings = 1000;
  /// Calls kept with a diagnostic: half of them from either end of the chain.
  static constexpr std::size_t kMaxCalls = 64;

  explicit Report(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  /// Adds an error; beyond kMaxErrors it is dropped.
  void error(Diagnostic d);
  /// An error behind which nothing of the program can be read.
  void last_error(Diagnostic d);
  void warning(Diagnostic d);
  /// A warning of a kind that a program makes many times: close() tells it once, at its first place, with how often it
  /// was met and where it was largest.
  /// @param size  of what is told; @param what  said behind the count, of the largest
  /// @param subject  of kinds that are told for each of several: a code of the program
  void repeated_warning(Diagnostic d, double size, std::string what, const std::string& subject = {});
  /// An error that a program repeats: told at the first place of each subject, and close() adds how often it was met.
  void repeated_error(Diagnostic d, const std::string& subject);
  /// A fact that a program gives many times: close() tells it once for each `key`, at its first place, with its count.
  /// @param key  one of a bounded number of texts
  void repeated_note(Diagnostic d, const std::string& key);
  /// Everything found so far, told or not.
  std::size_t found() const { return errors_ + warnings_ + met_; }
  /// The text whose first error may say that it is of another kind (gcode/read/other_kind.h): that is told in its place,
  /// and reading ends.
  void watch_kind(std::uint32_t file, std::string_view text, Dialect dialect) {
    watched_ = {file, text, rules_of(dialect).macros.on};
  }
  /// The calls in force while the program runs, outermost first, as they are pushed and popped: every
  /// diagnostic from now on carries them. Null: none. The vector must outlive its use here.
  void set_call_chain(const std::vector<Span>* chain) { chain_ = chain; }

  /// Position of everything reported from now on, whatever position it names itself: for words that kadr runs on
  /// the program's behalf and that are nowhere in its text. Nothing: its own position again.
  void set_place(std::optional<Span> place) { place_ = place; }

  /// Errors found, repeated ones included: grows with every call of error().
  std::size_t errors() const { return errors_; }
  /// True once further reading is pointless.
  bool full() const { return stopped_ || told_errors_ >= kMaxErrors; }
  /// Tells the repeated warnings, and how much the bounds left out.
  void close(Span end);

 private:
  struct Repeated {
    Diagnostic first;
    std::size_t count = 0;
    double largest = 0;
    std::string what;
  };
  struct Watched {
    std::uint32_t file = 0;
    std::string_view text;
    bool macros = false;  ///< macro B is not another kind
  };
  bool first_time(const Diagnostic& d);
  bool tell_kind(const Diagnostic& d);
  void take_calls(Diagnostic& d) const;
  void add(Diagnostic d);

  using Key = std::tuple<Code, std::uint32_t, std::uint32_t, std::uint32_t>;
  Diagnostics& diagnostics_;
  const std::vector<Span>* chain_ = nullptr;
  std::optional<Span> place_;
  std::set<Key> told_;  ///< code and position; as bounded as the diagnostics
  std::size_t errors_ = 0;
  std::size_t told_errors_ = 0;
  std::size_t warnings_ = 0;
  std::size_t met_ = 0;  ///< repeated warnings
  bool stopped_ = false;
  struct Counted {
    std::size_t count = 0;
    std::size_t told = 0;  ///< its place in the list and one; 0: it was not told
  };
  using Subject = std::pair<Code, std::string>;
  std::map<Subject, Repeated> repeated_;
  std::map<Subject, Counted> repeated_errors_;
  std::map<std::string, Repeated> noted_;
  std::optional<Watched> watched_;
};

/// A diagnostic with the code's title as its headline.
Diagnostic problem(Code code, Span span, std::string label, std::string help = {});

/// A length or angle for a message: shortest form within `decimals`, at least one digit: "5.6", "0.0283".
std::string figure(double value, int decimals = 4);

}  // namespace kadr::gcode
