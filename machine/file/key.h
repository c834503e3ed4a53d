#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

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

/// @tparam Model  the struct that the table is read into
/// @tparam Value  double or int (a whole number), bool, or an enumeration
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

template <class Model, class Value>
constexpr Key<Model, Value> key(std::string_view name, Value Model::*member, Bounds bounds,
                                std::string_view sentence) {
  bounds.whole = bounds.whole || std::is_same_v<Value, int>;
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

/// Reads one key into its member, which holds its default.
/// @param needed  whether the key must be given
template <class Model, class Value>
Reading<double> read_key(TableReader& r, Model& model, const Key<Model, Value>& key, AxisKind kind,
                         bool needed) {
  Value& member = model.*key.member;
  const std::optional<double> otherwise = needed ? std::nullopt : std::optional<double>(member);
  const auto read = r.number(spelled(key.name, kind), key.bounds, otherwise);
  member = static_cast<Value>(read.value);
  return read;
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
    // an axis's keys carry two units: the bounds are in that of the key
    const bool one_unit = key.name.find('{') == std::string_view::npos;
    d.allowed = bounds_text(key.bounds, one_unit ? key.name : "");
    d.otherwise = default_text(static_cast<double>(value), key.bounds.whole);
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

template <class... Keys>
void document_keys(TableDocument& table, const std::tuple<Keys...>& keys) {
  std::apply([&](const auto&... each) { (table.keys.push_back(document(each)), ...); }, keys);
}

}  // namespace kadr::machine
