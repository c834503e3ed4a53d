#pragma once
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "machine/base/vocabulary.h"
#include "machine/file/tree.h"
#include "machine/machine_file.h"

namespace kadr::machine {

/// The numbers that a key accepts. Every setting is bounded, so that no later product overflows or underflows.
struct Bounds {
  double low = 0;
  double high = 0;
  bool infinite = false;  ///< inf is allowed too (-inf if low < 0)
  bool whole = false;     ///< whole numbers only
};

/// "1 to 100 %, or inf", in the unit of the key.
std::string bounds_text(const Bounds& bounds, std::string_view key);

/// The value read from a key. `value` can be used even if it is not valid (then it is some allowed number), so
/// that the rest of the file is still checked.
template <class T>
struct Reading {
  T value{};
  bool valid = false;  ///< given and right, or a default
  Span span;           ///< the value; of a default the table's header
};

/// State shared by all tables of a file.
struct ReadContext {
  Diagnostics& diagnostics;
  const SourceSet& sources;
  bool complete = true;  ///< ParsedTree::complete
  std::vector<KeyOrigin> origins;
};

/// Reads one table key by key and reports every mistake: unknown keys with the nearest name, keys with another
/// unit with the converted line, missing keys, wrong types, values out of range. Ask for all keys, then call finish().
class TableReader {
 public:
  /// @param table  nullptr: the table is missing; every key is then missing or has its default
  /// @param path   as in settings: "", "feed", "axis.X.plant"
  TableReader(const Node* table, std::string path, Span missing_place, ReadContext& context);

  /// A number; `otherwise` is the default, nothing means that the key is required.
  Reading<double> number(std::string_view key, const Bounds& bounds, std::optional<double> otherwise = {});
  /// Two numbers [low, high].
  Reading<std::pair<double, double>> pair(std::string_view key, const Bounds& bounds,
                                          std::optional<std::pair<double, double>> otherwise = {});
  Reading<std::string> text(std::string_view key, const std::optional<std::string>& otherwise = {});
  Reading<bool> flag(std::string_view key, bool otherwise);
  /// One of several words, by its index in `words`.
  Reading<std::size_t> word(std::string_view key, std::span<const std::string_view> words,
                            std::optional<std::size_t> otherwise = {});
  /// One word of a vocabulary.
  template <class Enum, std::size_t kCount>
  Reading<Enum> choice(std::string_view key, const Vocabulary<Enum, kCount>& vocabulary,
                       std::optional<std::type_identity_t<Enum>> otherwise = {}) {
    std::string_view words[kCount];
    for (std::size_t i = 0; i < kCount; ++i) words[i] = vocabulary.words[i].word;
    std::optional<std::size_t> index;
    if (otherwise) index = static_cast<std::size_t>(*otherwise);
    const auto read = word(key, words, index);
    return {vocabulary.words[read.value].value, read.valid, read.span};
  }
  /// A table inside this one; nullptr if it is missing.
  const Node* table(std::string_view key);
  /// An array of tables inside this one; empty if it is missing.
  const std::vector<Node>& tables(std::string_view key);
  /// A list of texts inside this table; empty if it is missing.
  std::vector<Reading<std::string>> texts(std::string_view key);
  /// Which of two keys for one thing is given (a setting of the command line beats the file): the first if none is.
  std::string_view one_of(std::string_view first, std::string_view second);

  bool has(std::string_view key) const { return table_ && table_->find(key); }
  /// Reports unknown and missing keys.
  void finish();

  /// Place of a key's value; of one that is not given the table's header.
  Span place(std::string_view key) const {
    const Entry* entry = table_ ? table_->find(key) : nullptr;
    return entry ? entry->value.span : header_;
  }
  const std::string& path() const { return path_; }
  std::string path_of(std::string_view key) const;
  /// Place for a mistake of the table as a whole.
  Span header() const { return header_; }
  ReadContext& context() { return context_; }

 private:
  const Entry* take(std::string_view key, bool required);
  std::optional<double> checked(const Node& value, std::string_view key, const Bounds& bounds);
  void wrong_type(const Entry& entry, std::string_view wanted);
  void tell_unknown(const Entry& entry);
  bool tell_other_unit(const Entry& entry);
  void not_missing(std::string_view key);

  const Node* table_;
  std::string path_;
  Span header_;
  ReadContext& context_;
  std::vector<std::string> known_;
  std::vector<std::string> missing_;
  std::vector<std::pair<std::string, std::string>> alternatives_;  ///< keys for one thing, from one_of()
};

}  // namespace kadr::machine
