#include "machine/file/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "machine/base/parse_number.h"
#include "machine/file/units.h"

namespace kadr::machine {

std::string bounds_text(const Bounds& bounds, std::string_view key) {
  const KeyParts parts = split_key(key);
  return fmt::format("{:g} to {:g}{}{}{}", bounds.low, bounds.high,
                     parts.unit ? " " + unit_text(*parts.unit) : "", bounds.whole ? ", whole numbers" : "",
                     !bounds.infinite ? ""
                     : bounds.low < 0 ? ", or -inf or inf"
                                      : ", or inf");
}

TableReader::TableReader(const Node* table, std::string path, Span missing_place, ReadContext& context)
    : table_(table), path_(std::move(path)), header_(table ? table->span : missing_place), context_(context) {
  // the root has no header of its own: its first character stands for it
  if (path_.empty()) header_.length = 1;
}

std::string TableReader::path_of(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

const Entry* TableReader::take(std::string_view key, bool required) {
  known_.emplace_back(key);
  const Entry* entry = table_ ? table_->find(key) : nullptr;
  if (!entry) {
    if (required) missing_.emplace_back(key);
    return nullptr;
  }
  const SourceText& source = context_.sources[entry->key_span.file];
  context_.origins.push_back({path_of(key), source.name() == kSettingSource
                                                ? source.name()
                                                : fmt::format("{}:{}", source.name(), entry->key_span.line)});
  return entry;
}

void TableReader::wrong_type(const Entry& entry, std::string_view wanted) {
  const Node& value = entry.value;
  Diagnostic d = file_diagnostic(Code::file_wrong_type, value.span,
                                 fmt::format("is {}, must be {}", kind_text(value.kind), wanted));
  d.message = fmt::format("{}: value has the wrong type", path_of(entry.key));
  if (value.kind == Node::Kind::text) {
    std::string dotted = value.text;
    std::replace(dotted.begin(), dotted.end(), ',', '.');
    if (parse_number(dotted)) {
      const bool comma = dotted != value.text;
      d.help = fmt::format("{}: {}", comma ? "a decimal point is a dot" : "write the number without quotes",
                           dotted);
    }
  }
  context_.diagnostics.add(std::move(d));
}

std::optional<double> TableReader::checked(const Node& value, std::string_view key, const Bounds& bounds) {
  const double x = value.number;
  const bool infinite = x == kInfinity || (x == -kInfinity && bounds.low < 0);
  if (infinite ? bounds.infinite
               : x >= bounds.low && x <= bounds.high && (!bounds.whole || x == std::floor(x)))
    return x;
  const bool range = std::isfinite(x);
  Diagnostic d = file_diagnostic(range ? Code::file_out_of_range : Code::file_not_finite, value.span, "");
  if (!range) {
    d.label = std::isnan(x) ? "is not a number" : fmt::format("is {}", number_text(x));
    d.message = fmt::format("{}: value must be finite", path_of(key));
  } else {
    d.label = fmt::format("is {}, must be {}", number_text(x),
                          x < bounds.low && bounds.low > 0 && x <= 0 ? "above 0"
                          : x < bounds.low                           ? "at least " + number_text(bounds.low)
                          : x > bounds.high                          ? "at most " + number_text(bounds.high)
                                                                     : "a whole number");
    d.message = fmt::format("{}: value is out of range", path_of(key));
  }
  d.notes.push_back("allowed: " + bounds_text(bounds, key));
  context_.diagnostics.add(std::move(d));
  return std::nullopt;
}

Reading<double> TableReader::number(std::string_view key, const Bounds& bounds,
                                    std::optional<double> otherwise) {
  const double safe = otherwise.value_or(std::min(std::max(1.0, bounds.low), bounds.high));
  const Entry* entry = take(key, !otherwise);
  if (!entry) return {safe, otherwise.has_value(), header_};
  if (entry->value.kind != Node::Kind::number) {
    wrong_type(*entry, bounds.whole ? "a whole number" : "a number");
    return {safe, false, entry->value.span};
  }
  const auto value = checked(entry->value, key, bounds);
  return {value.value_or(safe), value.has_value(), entry->value.span};
}

Reading<std::pair<double, double>> TableReader::pair(std::string_view key, const Bounds& bounds,
                                                     std::optional<std::pair<double, double>> otherwise) {
  const auto safe = otherwise.value_or(std::pair{bounds.low, bounds.high});
  const Entry* entry = take(key, !otherwise);
  if (!entry) return {safe, otherwise.has_value(), header_};
  const Node& list = entry->value;
  const auto is_number = [](const Node& n) { return n.kind == Node::Kind::number; };
  if (list.kind != Node::Kind::array || list.items.size() != 2 ||
      !std::all_of(list.items.begin(), list.items.end(), is_number)) {
    wrong_type(*entry, "a list of two numbers [lowest, highest]");
    return {safe, false, list.span};
  }
  const auto low = checked(list.items[0], key, bounds), high = checked(list.items[1], key, bounds);
  if (!low || !high) return {safe, false, list.span};
  return {{*low, *high}, true, list.span};
}

Reading<std::string> TableReader::text(std::string_view key, const std::optional<std::string>& otherwise) {
  const Entry* entry = take(key, !otherwise);
  if (!entry) return {otherwise.value_or(""), otherwise.has_value(), header_};
  if (entry->value.kind != Node::Kind::text) {
    wrong_type(*entry, "a text in quotes");
    return {otherwise.value_or(""), false, entry->value.span};
  }
  return {entry->value.text, true, entry->value.span};
}

Reading<bool> TableReader::flag(std::string_view key, bool otherwise) {
  const Entry* entry = take(key, false);
  if (!entry) return {otherwise, true, header_};
  if (entry->value.kind != Node::Kind::boolean) {
    wrong_type(*entry, "true or false");
    return {otherwise, false, entry->value.span};
  }
  return {entry->value.boolean, true, entry->value.span};
}

Reading<std::size_t> TableReader::word(std::string_view key, std::span<const std::string_view> words,
                                       std::optional<std::size_t> otherwise) {
  const Entry* entry = take(key, !otherwise);
  if (!entry) return {otherwise.value_or(0), otherwise.has_value(), header_};
  const Span& span = entry->value.span;
  if (entry->value.kind != Node::Kind::text) {
    wrong_type(*entry, "a text in quotes");
    return {otherwise.value_or(0), false, span};
  }
  const auto found = std::find(words.begin(), words.end(), entry->value.text);
  if (found != words.end()) return {static_cast<std::size_t>(found - words.begin()), true, span};

  Diagnostic d = file_diagnostic(Code::file_unknown_word, span, "is not one of the choices");
  d.message = fmt::format("{}: unknown choice", path_of(key));
  d.notes.push_back(fmt::format("allowed: \"{}\"", fmt::join(words, "\", \"")));
  const auto nearest =
      std::min_element(words.begin(), words.end(), [&](std::string_view a, std::string_view b) {
        return edit_distance(entry->value.text, a) < edit_distance(entry->value.text, b);
      });
  if (edit_distance(entry->value.text, *nearest) <= static_cast<int>(nearest->size()) / 3)
    d.help = fmt::format("did you mean \"{}\"?", *nearest);
  context_.diagnostics.add(std::move(d));
  return {otherwise.value_or(0), false, span};
}

const Node* TableReader::table(std::string_view key) {
  known_.emplace_back(key);
  const Entry* entry = table_ ? table_->find(key) : nullptr;
  if (!entry) return nullptr;
  if (entry->value.kind == Node::Kind::table) return &entry->value;
  wrong_type(*entry, fmt::format("a table [{}]", path_of(key)));
  return nullptr;
}

const std::vector<Node>& TableReader::tables(std::string_view key) {
  static const std::vector<Node> none;
  known_.emplace_back(key);
  const Entry* entry = table_ ? table_->find(key) : nullptr;
  if (!entry) return none;
  const auto is_table = [](const Node& n) { return n.kind == Node::Kind::table; };
  if (entry->value.kind == Node::Kind::array &&
      std::all_of(entry->value.items.begin(), entry->value.items.end(), is_table))
    return entry->value.items;
  wrong_type(*entry, fmt::format("a list of tables, each beginning with [[{}]]", path_of(key)));
  return none;
}

std::vector<Reading<std::string>> TableReader::texts(std::string_view key) {
  std::vector<Reading<std::string>> list;
  const Entry* entry = take(key, false);
  if (!entry) return list;
  const auto is_text = [](const Node& n) { return n.kind == Node::Kind::text; };
  const std::vector<Node>& items = entry->value.items;
  if (entry->value.kind != Node::Kind::array || !std::all_of(items.begin(), items.end(), is_text)) {
    wrong_type(*entry, "a list of texts");
    return list;
  }
  for (const Node& item : items) list.push_back({item.text, true, item.span});
  return list;
}

std::string_view TableReader::one_of(std::string_view first, std::string_view second) {
  const Entry* a = table_ ? table_->find(first) : nullptr;
  const Entry* b = table_ ? table_->find(second) : nullptr;
  // the other one stays known, so that finish() doesn't report it
  const std::string_view chosen = a && b ? (b->key_span.file > a->key_span.file ? second : first)
                                  : b    ? second
                                         : first;
  known_.emplace_back(chosen == first ? second : first);
  alternatives_.emplace_back(first, second);
  if (a && b && a->key_span.file == b->key_span.file) {
    Diagnostic d =
        file_diagnostic(Code::file_keys_exclude, b->key_span, fmt::format("{} is given above", first));
    if (a->key_span.line > b->key_span.line) {
      d.span = a->key_span;
      d.label = fmt::format("{} is given above", second);
    }
    d.message = fmt::format("{}: give {} or {}, not both", path_, first, second);
    d.help = "keep one of the two";
    context_.diagnostics.add(std::move(d));
  }
  return chosen;
}

void TableReader::not_missing(std::string_view key) {
  const auto drop = [this](std::string_view k) {
    missing_.erase(std::remove(missing_.begin(), missing_.end(), k), missing_.end());
  };
  drop(key);
  for (const auto& [first, second] : alternatives_) {
    if (key == first) drop(second);
    if (key == second) drop(first);
  }
}

/// The value as one would write it in the file.
static std::string value_text(const Node& value) {
  switch (value.kind) {
    case Node::Kind::number:
      return number_text(value.number);
    case Node::Kind::text:
      return '"' + value.text + '"';
    case Node::Kind::boolean:
      return value.boolean ? "true" : "false";
    case Node::Kind::table:
    case Node::Kind::array:
    case Node::Kind::date:
      break;
  }
  return "...";
}

/// A number, or a list of numbers, in another unit with 12 digits; nothing if it is neither.
static std::optional<std::string> converted_text(const Node& value, const Unit& from, const Unit& to) {
  if (value.kind == Node::Kind::number)
    if (const auto x = convert(value.number, from, to)) return fmt::format("{:.12g}", *x);
  if (value.kind != Node::Kind::array || value.items.empty()) return std::nullopt;
  std::string list;
  for (const Node& item : value.items) {
    const auto text = item.kind == Node::Kind::number ? converted_text(item, from, to) : std::nullopt;
    if (!text) return std::nullopt;
    list += (list.empty() ? "" : ", ") + *text;
  }
  return '[' + list + ']';
}

bool TableReader::tell_other_unit(const Entry& entry) {
  const KeyParts given = split_key(entry.key);
  for (const std::string& key : known_) {
    const KeyParts known = split_key(key);
    if (!known.unit) continue;
    const bool same_stem =
        given.stem.size() == known.stem.size() && edit_distance(given.stem, known.stem) == 0;
    if (!same_stem || (given.unit && given.unit->suffix == known.unit->suffix)) continue;

    Diagnostic d = file_diagnostic(Code::file_other_unit, entry.key_span, "");
    d.message = fmt::format("{}: key has another unit", path_of(entry.key));
    if (!given.unit) {
      d.message = fmt::format("{}: key has no unit", path_of(entry.key));
      d.label = fmt::format("in which unit? kadr reads {}", unit_text(*known.unit));
      d.help = fmt::format("write {} = {}", key, value_text(entry.value));
    } else {
      d.label = fmt::format("is in {}, kadr reads {}", unit_text(*given.unit), unit_text(*known.unit));
      const auto value = converted_text(entry.value, *given.unit, *known.unit);
      d.help = fmt::format("write {} = {}", key, value.value_or("..."));
      if (!value && given.unit->quantity != known.unit->quantity)
        d.notes.push_back(
            "the two units measure different things; linear axes are in mm, rotary axes in deg");
    }
    // both spellings at once is a separate mistake: the right one is read
    not_missing(key);
    context_.diagnostics.add(std::move(d));
    return true;
  }
  return false;
}

void TableReader::tell_unknown(const Entry& entry) {
  if (tell_other_unit(entry)) return;
  Diagnostic d = file_diagnostic(Code::file_unknown_key, entry.key_span, "is not a key of this table");
  d.message = fmt::format("{}: unknown key", path_of(entry.key));
  if (path_.empty()) d.label = "is not a key or table of this file";

  const std::string* nearest = nullptr;
  int distance = 0;
  for (const std::string& key : known_) {
    // a key of any length would take the time of its length times that of each name
    if (entry.key.size() > 2 * key.size()) continue;
    const int edits = edit_distance(entry.key, key);
    if (!nearest || edits < distance) {
      nearest = &key;
      distance = edits;
    }
  }
  if (nearest && distance <= std::max(1, static_cast<int>(nearest->size()) / 3)) {
    d.help = fmt::format("did you mean {}?", *nearest);
    not_missing(*nearest);
  } else {
    std::vector<std::string> keys = known_;
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    d.notes.push_back(fmt::format("known here: {}", fmt::join(keys, ", ")));
  }
  context_.diagnostics.add(std::move(d));
}

void TableReader::finish() {
  if (table_)
    for (const Entry& entry : table_->entries)
      if (!context_.diagnostics.full() && std::find(known_.begin(), known_.end(), entry.key) == known_.end())
        tell_unknown(entry);
  if (!context_.complete || context_.diagnostics.full()) return;
  for (const std::string& key : missing_) {
    Diagnostic d = file_diagnostic(Code::file_missing_key, header_, fmt::format("{} is not given", key));
    d.message = fmt::format("{}: missing key", path_of(key));
    d.help = fmt::format(
        "write {} = ... {}", key,
        path_.empty() ? "at the beginning of the file" : fmt::format("in the table of {}", path_));
    context_.diagnostics.add(std::move(d));
  }
}

}  // namespace kadr::machine
