#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "machine/base/diagnostic.h"

/// A settings file as a plain tree: what was written, each key and value with its place. Machine and scenario
/// files are read from it by TableReader, so that both report mistakes in the same words.
namespace kadr::machine {

struct Entry;

/// One value of a settings file.
struct Node {
  enum class Kind { table, array, number, text, boolean, date };
  Kind kind = Kind::table;
  Span span;          ///< the value; of a table its header; of a value on several lines the first line
  double number = 0;  ///< Kind::number; may be inf or nan
  bool boolean = false;
  std::string text;            ///< Kind::text
  std::vector<Node> items;     ///< Kind::array
  std::vector<Entry> entries;  ///< Kind::table, in the order of the file

  Entry* find(std::string_view key);
  const Entry* find(std::string_view key) const;
};

struct Entry {
  std::string key;
  Span key_span;
  Node value;
};

/// The kind of a value, for messages: "a number", "a text", "a table" ...
std::string_view kind_text(Node::Kind kind);

/// An error with its code's title as message; the caller fills in the rest.
Diagnostic file_diagnostic(Code code, const Span& span, std::string label);

/// A file, read as far as possible.
struct ParsedTree {
  Node root;
  bool complete = true;  ///< false: lines with a syntax error were left out, so a missing key proves nothing
};

/// Reads sources[file] as TOML. A line with a syntax error is reported and skipped, and reading continues, so that
/// the mistakes of the rest are found in the same run (at most 20 such lines, none after a broken table header).
ParsedTree parse_toml(const SourceSet& sources, std::uint32_t file, Diagnostics& diagnostics);

/// One value as TOML writes it; what is neither a number nor TOML is a text. All its spans are `span`.
Node parse_value(const std::string& value, const Span& span);

/// Puts "key=value" settings of the command line into the tree: "feed.max_jerk_mm_s3=2e4",
/// "axis.X.plant.model=rigid" (X is the `name` of a table in the array `axis`). Each setting becomes a text
/// in `sources`, named kSettingSource, so that its diagnostics have a place. A value that is not
/// TOML is a text.
void apply_settings(Node& root, const std::vector<std::string>& settings, SourceSet& sources,
                    Diagnostics& diagnostics);

inline constexpr std::string_view kSettingSource = "command line";

}  // namespace kadr::machine
