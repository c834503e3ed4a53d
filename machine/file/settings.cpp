#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "machine/file/toml_places.h"
#include "machine/file/tree.h"

namespace kadr::machine {

namespace {

/// Walks the keys of one setting from the root to the place of its value.
class Setting {
 public:
  Setting(std::uint32_t file, std::string_view text) : file_(file), text_(text), equal_(text.find('=')) {}

  std::optional<Diagnostic> apply(Node& root) const {
    if (equal_ == std::string_view::npos || equal_ == 0)
      return problem(0, text_.size(), "is not key=value", "for example feed.max_mm_s=50");
    if (text_.find_first_of("\n\r") != std::string_view::npos)
      return problem(0, text_.size(), "is more than one line", "");
    const std::string_view path = text_.substr(0, equal_);
    const auto parts = 1 + static_cast<std::size_t>(std::count(path.begin(), path.end(), '.'));
    if (parts > kMostKeyParts)
      return problem(0, equal_, fmt::format("has {} parts, allowed: {}", parts, kMostKeyParts), "");
    Node* table = &root;
    std::size_t begin = 0;
    for (;;) {
      const std::size_t end = std::min(text_.find('.', begin), equal_);
      const std::string key(text_.substr(begin, end - begin));
      if (key.empty()) return problem(begin, 1, "an empty name", "for example axis.X.max_mm_s=50");
      if (end == equal_) {
        put(*table, key, begin);
        return std::nullopt;
      }
      if (auto d = enter(table, key, begin, end)) return d;
      begin = end < equal_ && end + 1 <= equal_ ? end + 1 : equal_;
      // "axis.X": the item of an array is chosen by its `name`
      if (table->kind == Node::Kind::array) {
        const std::size_t name_end = std::min(text_.find('.', begin), equal_);
        const std::string name(text_.substr(begin, name_end - begin));
        if (auto d = choose(table, key, name, begin)) return d;
        if (name_end == equal_) return problem(begin, name.size(), "names a table, not a value", "");
        begin = name_end + 1;
      }
    }
  }

 private:
  Span span(std::size_t begin, std::size_t length) const {
    return {file_, 1, static_cast<std::uint32_t>(begin + 1), static_cast<std::uint32_t>(length)};
  }

  Diagnostic problem(std::size_t begin, std::size_t length, std::string label, std::string help) const {
    Diagnostic d = file_diagnostic(Code::file_setting, span(begin, length), std::move(label));
    d.help = std::move(help);
    return d;
  }

  std::optional<Diagnostic> enter(Node*& table, const std::string& key, std::size_t begin,
                                  std::size_t end) const {
    Entry* entry = table->find(key);
    if (!entry) {
      table->entries.push_back({key, span(begin, end - begin), Node{}});
      entry = &table->entries.back();
      entry->value.span = entry->key_span;
    }
    const Node::Kind kind = entry->value.kind;
    if (kind != Node::Kind::table && kind != Node::Kind::array)
      return problem(begin, end - begin, "is " + std::string(kind_text(kind)) + ", not a table", "");
    table = &entry->value;
    return std::nullopt;
  }

  std::optional<Diagnostic> choose(Node*& array, const std::string& key, const std::string& name,
                                   std::size_t begin) const {
    std::string names;
    for (Node& item : array->items) {
      const Entry* entry = item.kind == Node::Kind::table ? item.find("name") : nullptr;
      if (!entry || entry->value.kind != Node::Kind::text) continue;
      if (entry->value.text == name) {
        array = &item;
        return std::nullopt;
      }
      names += (names.empty() ? "" : ", ") + entry->value.text;
    }
    return problem(begin, std::max<std::size_t>(name.size(), 1), "there is no " + key + " of this name",
                   names.empty() ? "" : "one of " + names);
  }

  void put(Node& table, const std::string& key, std::size_t begin) const {
    const Span value_span = span(equal_ + 1, std::max<std::size_t>(text_.size() - equal_ - 1, 1));
    Node value = parse_value(std::string(text_.substr(equal_ + 1)), value_span);
    const Span key_span = span(begin, equal_ - begin);
    if (Entry* entry = table.find(key)) {
      entry->key_span = key_span;
      entry->value = std::move(value);
    } else {
      table.entries.push_back({key, key_span, std::move(value)});
    }
  }

  std::uint32_t file_;
  std::string_view text_;
  std::size_t equal_;
};

}  // namespace

void apply_settings(Node& root, const std::vector<std::string>& settings, SourceSet& sources,
                    Diagnostics& diagnostics) {
  for (const std::string& text : settings) {
    const std::uint32_t file = sources.add(SourceText(std::string(kSettingSource), text));
    if (auto d = Setting(file, sources[file].text()).apply(root)) diagnostics.add(std::move(*d));
  }
}

}  // namespace kadr::machine
