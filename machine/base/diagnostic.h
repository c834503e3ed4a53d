#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "machine/base/codes.h"
#include "machine/base/severity.h"

namespace kadr {

struct InputFile;

/// A place in a text: 1-based line and 1-based byte column; length in bytes. line == 0: no place.
struct Span {
  std::uint32_t file = 0;  ///< index in a SourceSet
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::uint32_t length = 0;
  constexpr bool operator==(const Span&) const = default;
};

/// A text can't be read. what() is "PATH: reason".
class UnreadableText : public std::system_error {
 public:
  UnreadableText(const std::string& path, std::errc code, std::string reason);
  const char* what() const noexcept override { return what_.c_str(); }
  const std::string& reason() const { return reason_; }

 private:
  std::string reason_, what_;
};

/// The largest machine, scenario or problem file that is read: TOML in memory takes 100 times its bytes and more.
inline constexpr std::uint64_t kMostSettings_bytes = std::uint64_t{8} << 20;
/// The largest table of tools or of a path that is read.
inline constexpr std::uint64_t kMostTable_bytes = std::uint64_t{1} << 30;

/// A text as read: a control program, machine or scenario file. The bytes stay as they are (no line-end conversion).
class SourceText {
 public:
  /// A text already in memory.
  SourceText(std::string name, std::string text);
  /// Reads a regular file, or standard input for "-", into memory: what happens to the file afterwards changes nothing.
  /// @param most_bytes  a larger file is refused before it is read, a longer input as soon as it is; 0: no bound
  /// Throws UnreadableText if the file can't be opened, lies outside its folders, is a folder, pipe or device, is too
  /// large, or changes while it is read.
  static SourceText open(const InputFile& file, std::uint64_t most_bytes);
  /// The same of a file that the user names: it may lie anywhere.
  static SourceText open(const std::string& path, std::uint64_t most_bytes);

  SourceText(SourceText&&) noexcept;
  SourceText& operator=(SourceText&&) noexcept;
  ~SourceText();

  const std::string& name() const { return name_; }  ///< as the user gave it
  std::string_view text() const { return *text_; }
  /// Line by 1-based number, without its line end; empty beyond the end. The line index is built at the first call.
  std::string_view line(std::uint32_t number) const;

 private:
  struct LineStart {
    std::uint32_t number = 1;
    std::size_t at = 0;
  };
  void index_lines() const;

  std::string name_;
  std::unique_ptr<const std::string> text_;  ///< stays where it is when this is moved
  mutable std::vector<LineStart>
      line_starts_;  ///< of some lines: at most 256 lines or 64 kB and a line apart
};

/// The texts that spans point into.
class SourceSet {
 public:
  std::uint32_t add(SourceText text);  ///< returns the file index for Span::file
  const SourceText& operator[](std::uint32_t file) const { return *texts_.at(file); }
  std::size_t size() const { return texts_.size(); }

 private:
  std::vector<std::unique_ptr<SourceText>> texts_;
};

/// One message to the user. `label` is printed at the caret and carries the measured value.
struct Diagnostic {
  Code code;
  Severity severity = Severity::error;
  Span span;
  std::string message;             ///< headline; usually code_entry(code).title with names filled in
  std::string label;               ///< at the caret: what was measured
  std::vector<std::string> notes;  ///< allowed value and the setting it comes from, further facts
  std::string help;                ///< what would be right
  std::vector<Span> calls = {};    ///< calls of subroutines that led here, innermost first
  std::size_t calls_left_out = 0;  ///< further calls, between the two halves of `calls`
};

/// Diagnostics in the order found. Reading continues after an error; nothing moves while has_errors(). Memory is
/// bounded: at most kMost errors and kMost warnings are kept, and texts that quote a file are cut. If some are not kept,
/// or reading stopped, one note of Code::too_many_errors in the list says so.
class Diagnostics {
 public:
  static constexpr std::size_t kMost = 2000;
  static constexpr std::size_t kMostText_bytes = 4000;

  void add(Diagnostic d);
  /// Adds a note to one that is in the list already.
  void add_note(std::size_t index, std::string note) { list_.at(index).notes.push_back(std::move(note)); }
  /// Those of another list, and what that one left out.
  void add(const Diagnostics& others);
  /// Counts errors or warnings that the caller found and does not keep; `at` is the note's place.
  void leave_out(Severity severity, std::size_t count, Span at);
  /// The caller stops reading here because of the errors so far: there may be more.
  void stop(Span at);
  /// By file, line and column.
  void sort_by_place();

  /// No further error is kept: reading on is pointless.
  bool full() const { return errors_ >= kMost; }
  bool has_errors() const { return errors_ > 0; }
  std::size_t errors() const { return errors_; }                                  ///< found, kept or not
  std::size_t warnings() const { return warnings_; }                              ///< found, kept or not
  std::size_t left_out() const { return left_out_errors_ + left_out_warnings_; }  ///< found and not kept
  bool stopped() const { return errors_read_ > 0; }
  const std::vector<Diagnostic>& list() const { return list_; }

 private:
  void tell_rest(Span at);

  std::vector<Diagnostic> list_;
  std::size_t errors_ = 0;
  std::size_t warnings_ = 0;
  std::size_t left_out_errors_ = 0;
  std::size_t left_out_warnings_ = 0;
  std::size_t errors_read_ = 0;  ///< when reading stopped
  std::size_t rest_ = 0;         ///< index of the note and one; 0: none yet
};

/// True for the note by which a list says that it is not complete.
bool tells_rest(const Diagnostic& d);

/// A place for people and tools: code points, not bytes.
struct Place {
  std::size_t column = 1;      ///< of the first code point, from 1
  std::size_t end_column = 1;  ///< behind the last one
};
/// False for a diagnostic that belongs to no line.
bool has_place(const Span& span, const SourceSet& sources);
/// @pre has_place(span, sources)
Place place_of(const Span& span, const SourceSet& sources);

/// The human form with source line and caret (docs/pipeline.md shows one). No colour codes unless `colour`.
std::string render_human(const Diagnostic& d, const SourceSet& sources, bool colour = false);
/// One line: part.ngc:42:6: error: message: label [K2107]; for each call that led here another one:
/// part.ngc:9:1: note: called from here: O100 call [5]
std::string render_gcc(const Diagnostic& d, const SourceSet& sources);
/// "2 errors, 1 warning"
std::string count_text(std::size_t errors, std::size_t warnings);

}  // namespace kadr
