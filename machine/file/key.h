#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "machine/base/count.h"
#include "machine/base/vocabulary.h"
#include "machine/choices.h"
#include "machine/file/table_reader.h"
#include "machine/machine_file.h"
#include "machine/two_masses.h"

/// A key of a settings file, declared once: it reads, prints, bounds and documents itself.
namespace kadr::machine {

/// When a key must be given.
enum class Need : std::uint8_t {
  never,   ///< its default is what the member holds before reading
  always,  ///< in every table of its kind
  link,    ///< unless the motor is `rigid` and none of these is given: then there is no flexible link
  motor,   ///< by the motors whose laws need it (machine/motor.h); others ignore it
};

/// A member of a model as the number that a file holds.
template <class Value>
requires std::is_arithmetic_v<Value>
constexpr double as_number(Value value) { return static_cast<double>(value); }
template <class Tag>
constexpr double as_number(Count<Tag> count) {
  return static_cast<double>(count.value);
}
template <class Value>
inline constexpr bool kWhole = std::is_integral_v<Value>;
template <class Tag>
inline constexpr bool kWhole<Count<Tag>> = true;

/// @tparam Model  the struct that the table is read into
/// @tparam Value  double, an integer or a Count (whole numbers), bool, or an enumeration
template <class Model, class Value>
struct Key {
  std::string_view name;  ///< of an axis with its unit as a place: "max_{u}_s" (spelled())
  Value Model::*member = nullptr;
  Bounds bounds = {};  ///< of a number
  std::string_view sentence = {};
  Need need = Need::never;
  std::string_view otherwise = {};  ///< in documents, of a default that depends on other keys

  constexpr Key required(Need when = Need::always) const {
    Key key = *this;
    key.need = when;
    return key;
  }
  constexpr Key default_is(std::string_view text) const {
    Key key = *this;
    key.otherwise = text;
    return key;
  }
};

/// A key that takes a word.
template <class Model, class Enum, std::size_t kCount>
struct WordKey {
  std::string_view name;
  Enum Model::*member = nullptr;
  const Vocabulary<Enum, kCount>* words = nullptr;
  std::string_view sentence = {};
  Need need = Need::never;
  std::string_view otherwise = {};

  constexpr WordKey required() const {
    WordKey key = *this;
    key.need = Need::always;
    return key;
  }
  constexpr WordKey default_is(std::string_view text) const {
    WordKey key = *this;
    key.otherwise = text;
    return key;
  }
};

/// A number that no plain member of a struct stands for: its reader says when it must be given.
struct NumberKey {
  std::string_view name;
  Bounds bounds;
  std::string_view sentence;
  std::string_view otherwise = {};  ///< in documents
};

template <class Model, class Value>
constexpr Key<Model, Value> key(std::string_view name, Value Model::*member, Bounds bounds,
                                std::string_view sentence) {
  bounds.whole = bounds.whole || kWhole<Value>;
  return {name, member, bounds, sentence};
}
template <class Model>
constexpr Key<Model, bool> key(std::string_view name, bool Model::*member, std::string_view sentence) {
  return {name, member, {}, sentence};
}
template <class Model, class Enum, std::size_t kCount>
constexpr WordKey<Model, Enum, kCount> key(std::string_view name, Enum Model::*member,
                                           const Vocabulary<Enum, kCount>& words, std::string_view sentence) {
  return {name, member, &words, sentence};
}

/// The keys of one table, in the order in which they are read and printed.
template <class... Keys>
constexpr std::tuple<Keys...> keys_of(Keys... keys) {
  return {keys...};
}

/// A key's name on an axis of that kind: "max_{u}_s" is max_mm_s or max_deg_s.
std::string spelled(std::string_view name, AxisKind kind);

/// Reads one key, under the name that it has in this table, into its member, which holds its default.
/// @param needed  whether the key must be given
template <class Model, class Value>
Reading<double> read_named(TableReader& r, Model& model, const Key<Model, Value>& key, std::string_view name,
                           bool needed) {
  Value& member = model.*key.member;
  const std::optional<double> otherwise = needed ? std::nullopt : std::optional<double>(as_number(member));
  const auto read = r.number(name, key.bounds, otherwise);
  if constexpr (std::is_arithmetic_v<Value>)
    member = static_cast<Value>(read.value);
  else
    member = {static_cast<std::int64_t>(read.value)};
  return read;
}
template <class Model, class Value>
Reading<double> read_key(TableReader& r, Model& model, const Key<Model, Value>& key, AxisKind kind,
                         bool needed) {
  return read_named(r, model, key, spelled(key.name, kind), needed);
}
template <class Model>
Reading<bool> read_key(TableReader& r, Model& model, const Key<Model, bool>& key, AxisKind, bool) {
  const auto read = r.flag(key.name, model.*key.member);
  model.*key.member = read.value;
  return read;
}
template <class Model, class Enum, std::size_t kCount>
Reading<Enum> read_key(TableReader& r, Model& model, const WordKey<Model, Enum, kCount>& key, AxisKind,
                       bool needed) {
  const std::optional<Enum> otherwise = needed ? std::nullopt : std::optional<Enum>(model.*key.member);
  const auto read = r.choice(key.name, *key.words, otherwise);
  model.*key.member = read.value;
  return read;
}
template <class Model, class OneKey>
auto read_key(TableReader& r, Model& model, const OneKey& key, AxisKind kind = AxisKind::linear) {
  return read_key(r, model, key, kind, key.need == Need::always);
}

/// @param otherwise  its default; nothing: the key must be given
inline Reading<double> read_number(TableReader& r, const NumberKey& key,
                                   std::optional<double> otherwise = {}) {
  return r.number(key.name, key.bounds, otherwise);
}

/// Reads all keys of a table into a model that holds their defaults.
template <class Model, class... Keys>
void read_keys(TableReader& r, Model& model, const std::tuple<Keys...>& keys,
               AxisKind kind = AxisKind::linear) {
  std::apply([&](const auto&... each) { (read_key(r, model, each, kind), ...); }, keys);
}

// ---- a key as the documents show it

/// A key without a member in the model; its reader is written by hand.
struct PlainKey {
  std::string_view name, allowed, otherwise, sentence;
};

/// "max_mm_s, max_deg_s"; the name alone if it has no unit of an axis.
std::string documented_name(std::string_view name);
/// An axis's keys carry two units: the bounds are in that of the key.
std::string documented_bounds(const Bounds& bounds, std::string_view name);
std::string need_text(Need need);
/// The same, with the names of the motors that need it.
std::string need_text(const Key<TwoMassModel, double>& key);
template <class AnyKey>
std::string need_text(const AnyKey& key) {
  return need_text(key.need);
}
std::string default_text(double value, bool whole);

template <class Model, class Value>
KeyDocument document(const Key<Model, Value>& key) {
  KeyDocument d{documented_name(key.name), "true or false", {}, std::string(key.sentence)};
  const Value value = Model{}.*key.member;
  if constexpr (std::is_same_v<Value, bool>) {
    d.otherwise = value ? "true" : "false";
  } else {
    d.allowed = documented_bounds(key.bounds, key.name);
    d.otherwise = default_text(as_number(value), key.bounds.whole);
  }
  if (!key.otherwise.empty()) d.otherwise = key.otherwise;
  if (key.need != Need::never) d.otherwise = need_text(key);
  return d;
}
template <class Model, class Enum, std::size_t kCount>
KeyDocument document(const WordKey<Model, Enum, kCount>& key) {
  KeyDocument d{std::string(key.name), {}, {}, std::string(key.sentence)};
  d.otherwise = '"' + std::string(key.words->word(Model{}.*key.member)) + '"';
  if (!key.otherwise.empty()) d.otherwise = key.otherwise;
  if (key.need != Need::never) d.otherwise = need_text(key);
  for (const auto& word : *key.words)
    d.words.emplace_back('"' + std::string(word.word) + '"', std::string(word.sentence));
  return d;
}

inline KeyDocument document(const PlainKey& key) {
  return {documented_name(key.name), std::string(key.allowed), std::string(key.otherwise),
          std::string(key.sentence)};
}

inline KeyDocument document(const NumberKey& key) {
  return {documented_name(key.name), documented_bounds(key.bounds, key.name), std::string(key.otherwise),
          std::string(key.sentence)};
}

template <class... Keys>
void document_keys(TableDocument& table, const std::tuple<Keys...>& keys) {
  std::apply([&](const auto&... each) { (table.keys.push_back(document(each)), ...); }, keys);
}

/// The tables of a file, each of single keys and of whole tuples of keys in the order given.
class Documents {
 public:
  Documents& table(std::string header, std::string sentence) {
    tables_.push_back({std::move(header), std::move(sentence), {}});
    return *this;
  }
  template <class OneKey>
  Documents& one(const OneKey& key) {
    tables_.back().keys.push_back(document(key));
    return *this;
  }
  template <class... Keys>
  Documents& all(const std::tuple<Keys...>& keys) {
    document_keys(tables_.back(), keys);
    return *this;
  }
  std::vector<TableDocument> take() { return std::move(tables_); }

 private:
  std::vector<TableDocument> tables_;
};

}  // namespace kadr::machine
