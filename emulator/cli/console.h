#pragma once
#include <stdexcept>
#include <string>
#include <string_view>

#include "emulator/cli/arguments.h"
#include "emulator/text/json.h"
#include "emulator/text/sarif.h"
#include "machine/base/diagnostic.h"
#include "machine/base/terminal_text.h"

namespace kadr::cli {

/// An I/O error: a file, disk or pipe. Exit code 2.
class WorldError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Standard output and standard error of a command. Data go out in large pieces; messages at once. All text is held to
/// what a terminal may be shown (emulator/cli/standard_streams.h).
class Console {
 public:
  explicit Console(const OutputOptions& options);
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;
  ~Console();

  const OutputOptions& options() const { return options_; }
  /// Text for people or in `--json`, to standard output. Throws WorldError when it can't be written.
  void data(std::string_view text);
  /// What else is written to files, such as a program, CSV or a page: byte for byte, but on a terminal as data().
  void bytes(std::string_view bytes);
  /// What people read beside a result: data, or a message once a result file is standard output.
  void summary(std::string_view text);
  /// Called before anything is written: the result file `path`, empty if there is none, may be standard output.
  /// @throws WorldError if something else goes there, too
  void claim_output(const std::string& path);
  /// A document in `--json`, as text with a line end.
  void document(const text::Json& json) { data(text::json_text(json) + '\n'); }
  /// A message with "kadr: " before it, to standard error; -q leaves notes out, and so does a document there.
  /// It is one line, whatever names it quotes.
  void note(std::string_view text);
  void error(std::string_view text);
  /// Diagnostics in the requested format, at most --max-errors of them, and a line that counts them; in SARIF
  /// they are gathered until finish().
  /// `where`: standard output for `kadr check`, whose data they are, else standard error.
  enum class Where { output, errors };
  void diagnostics(const Diagnostics& list, const SourceSet& sources, const std::string& subject,
                   Where where);
  /// Flushes; throws WorldError if anything could not be written.
  void flush();
  /// Ends a command with that exit code: writes what was gathered for one document.
  void finish(int exit_code);

 private:
  void gather(std::string_view text, Styles styles);
  void message(std::string_view text, Styles styles);
  bool colour(Where where) const;
  bool sarif() const { return options_.format == DiagnosticFormat::sarif && !options_.json; }

  OutputOptions options_;
  std::string buffer_;  ///< what goes to standard output next, as it goes there
  bool terminal_;       ///< standard output is one
  text::SarifLog sarif_;
  Where sarif_where_ = Where::errors;
  bool output_claimed_ = false;  ///< standard output is a result file
};

/// The diagnostics in order of file, line and column; those without a place come first.
std::vector<const Diagnostic*> by_place(const Diagnostics& list);

}  // namespace kadr::cli
