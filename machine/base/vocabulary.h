#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace kadr {

/// One word of a vocabulary: the enumerator, its spelling in files and on the command line, and its meaning.
template <class Enum>
struct Word {
  Enum value{};
  std::string_view word;
  std::string_view sentence = {};
};

namespace vocabulary {

/// Whether the enumeration declares this value. The compiler spells a declared enumerator by its name, and
/// any other value as a cast: "[with auto kValue = Hue::red]", "[with auto kValue = (Hue)7]". Clang's
/// "(anonymous namespace)::" is no cast.
template <auto kValue>
constexpr bool is_declared() {
  const std::string_view text = __PRETTY_FUNCTION__;
  const std::string_view value = text.substr(text.find("kValue = "));
  const std::size_t closed = value.rfind(')');
  return closed == value.npos || value[closed + 1] == ':';
}

template <class Enum, std::size_t... kIndex>
constexpr bool all_declared(std::index_sequence<kIndex...>) {
  return (is_declared<static_cast<Enum>(kIndex)>() && ...);
}

}  // namespace vocabulary

/// The words of an enumeration whose enumerators count from 0. The only list: readers, writers, the command
/// line, documents and tests take them from here.
///
///   enum class Hue : std::uint8_t { red, green };
///   inline constexpr Vocabulary<Hue, 2> kHues{{{Hue::red, "red", "like blood"}, {Hue::green, "green"}}};
///   static_assert(kHues.complete());
template <class Enum, std::size_t kCount>
struct Vocabulary {
  using Value = Enum;

  Word<Enum> words[kCount];

  /// Each enumerator once, in order, with a word that no other one has; none is left out. For a
  /// static_assert: an enumerator without a word then does not compile.
  static constexpr bool covers_enumeration() {
    return vocabulary::all_declared<Enum>(std::make_index_sequence<kCount>()) &&
           !vocabulary::is_declared<static_cast<Enum>(kCount)>();
  }
  constexpr bool complete() const { return covers_enumeration() && in_order(); }
  constexpr bool in_order() const {
    for (std::size_t i = 0; i < kCount; ++i) {
      if (static_cast<std::size_t>(words[i].value) != i) return false;
      for (std::size_t j = 0; j < i; ++j)
        if (words[j].word == words[i].word) return false;
    }
    return true;
  }

  /// Empty for a value that a part of a vocabulary (up_to, words_where) leaves out.
  constexpr std::string_view word(Enum value) const { return entry(value).word; }
  constexpr std::string_view sentence(Enum value) const { return entry(value).sentence; }
  constexpr Word<Enum> entry(Enum value) const {
    const auto index = static_cast<std::size_t>(value);
    if (index < kCount && words[index].value == value) return words[index];
    for (const Word<Enum>& each : words)
      if (each.value == value) return each;
    return {};
  }
  /// Nothing if the vocabulary doesn't have the word.
  constexpr std::optional<Enum> find(std::string_view word) const {
    for (const Word<Enum>& entry : words)
      if (entry.word == word) return entry.value;
    return std::nullopt;
  }
  /// The value of a number that was stored (a log's integer); nothing if the enumeration has no such value.
  constexpr std::optional<Enum> at(std::int64_t number) const {
    if (number < 0 || number >= static_cast<std::int64_t>(kCount)) return std::nullopt;
    return words[static_cast<std::size_t>(number)].value;
  }
  /// The first enumerators alone, up to `kLast`: not complete, but in order.
  template <Enum kLast>
  constexpr Vocabulary<Enum, static_cast<std::size_t>(kLast) + 1> up_to() const {
    Vocabulary<Enum, static_cast<std::size_t>(kLast) + 1> part{};
    for (std::size_t i = 0; i < part.size(); ++i) part.words[i] = words[i];
    return part;
  }

  constexpr const Word<Enum>* begin() const { return words; }
  constexpr const Word<Enum>* end() const { return words + kCount; }
  static constexpr std::size_t size() { return kCount; }

  std::vector<std::string> strings() const {
    std::vector<std::string> list;
    for (const Word<Enum>& entry : words) list.emplace_back(entry.word);
    return list;
  }
  /// "linear, rotary"
  std::string list(std::string_view separator = ", ") const {
    std::string text;
    for (const Word<Enum>& entry : words) {
      if (!text.empty()) text += separator;
      text += entry.word;
    }
    return text;
  }
};

/// The words whose value `keep` accepts, in order; `keep` captures nothing.
template <const auto& kWords, class Keep>
constexpr auto words_where(Keep) {
  constexpr std::size_t kKept = [] {
    std::size_t kept = 0;
    for (const auto& word : kWords) kept += Keep{}(word.value) ? 1 : 0;
    return kept;
  }();
  Vocabulary<typename std::remove_cvref_t<decltype(kWords)>::Value, kKept> part{};
  std::size_t next = 0;
  for (const auto& word : kWords)
    if (Keep{}(word.value)) part.words[next++] = word;
  return part;
}

/// A word that was stored: of a vocabulary, or one that a newer or foreign writer knows. That one keeps its
/// text, and is equal to no enumerator.
template <const auto& kWords>
class StoredWord {
 public:
  using Enum = typename std::remove_cvref_t<decltype(kWords)>::Value;

  StoredWord(Enum value) : value_(value) {}
  /// A text as it was read.
  static StoredWord read(std::string text) {
    StoredWord word{Enum{}};
    word.value_ = kWords.find(text);
    if (!word.value_) word.foreign_ = std::move(text);
    return word;
  }

  /// Nothing for a foreign word.
  std::optional<Enum> value() const { return value_; }
  std::string text() const { return value_ ? std::string(kWords.word(*value_)) : foreign_; }
  bool operator==(const StoredWord&) const = default;
  bool operator==(Enum value) const { return value_ == value; }

 private:
  std::optional<Enum> value_;
  std::string foreign_;
};

}  // namespace kadr
