#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "machine/base/parse_number.h"
#include "machine/base/utf8.h"
#include "machine/file/toml_places.h"
#include "machine/file/tree.h"

namespace kadr::machine {

namespace {

constexpr int kMaxSyntaxErrors = 20;

/// Turns toml++ nodes into ours; spans count in the text of one file.
class Converter {
 public:
  Converter(std::string_view text, std::uint32_t file) : places_(text), file_(file) {}

  Span span(const toml::source_region& region) {
    const std::uint32_t begin = places_.byte_column(region.begin.line, region.begin.column);
    const auto line_end = static_cast<std::uint32_t>(places_.line(region.begin.line).size() + 1);
    const std::uint32_t end = region.end.line == region.begin.line
                                  ? places_.byte_column(region.begin.line, region.end.column)
                                  : line_end;
    return {file_, region.begin.line, begin, end > begin ? end - begin : 1};
  }

  Node node(const toml::node& from) {
    Node to;
    to.span = span(from.source());
    if (const auto* table = from.as_table()) {
      for (const auto& [key, value] : *table)
        to.entries.push_back({std::string(key.str()), span(key.source()), node(value)});
      std::stable_sort(to.entries.begin(), to.entries.end(), [](const Entry& a, const Entry& b) {
        return std::pair(a.key_span.line, a.key_span.column) < std::pair(b.key_span.line, b.key_span.column);
      });
    } else if (const auto* array = from.as_array()) {
      to.kind = Node::Kind::array;
      for (const toml::node& item : *array) to.items.push_back(node(item));
    } else if (const auto* real = from.as_floating_point()) {
      to.kind = Node::Kind::number;
      to.number = real->get();
    } else if (const auto* integer = from.as_integer()) {
      to.kind = Node::Kind::number;
      to.number = static_cast<double>(integer->get());
    } else if (const auto* text = from.as_string()) {
      to.kind = Node::Kind::text;
      to.text = text->get();
    } else if (const auto* flag = from.as_boolean()) {
      to.kind = Node::Kind::boolean;
      to.boolean = flag->get();
    } else {
      to.kind = Node::Kind::date;
    }
    return to;
  }

 private:
  TomlPlaces places_;
  std::uint32_t file_;
};

/// "Error while parsing table header: expected ']', saw '\\n'" -> "expected ']', saw the end of the line"
std::string plain_words(std::string_view description) {
  constexpr std::string_view preamble = "Error while parsing ", line_end = "'\\n'";
  std::string text(description);
  const auto colon = text.find(": ");
  if (text.starts_with(preamble) && colon != std::string::npos) text.erase(0, colon + 2);
  if (!text.empty() && text.front() >= 'A' && text.front() <= 'Z')
    text.front() = static_cast<char>(text.front() + 32);
  if (const auto at = text.find(line_end); at != std::string::npos)
    text.replace(at, line_end.size(), "the end of the line");
  return text;
}

/// Advice for common mistakes: decimal commas, units after numbers, texts without quotes.
std::string syntax_help(std::string_view line) {
  const auto equal = line.find('=');
  if (equal == std::string_view::npos)
    return line.find('[') == std::string_view::npos ? "write key = value" : "";
  std::string_view value = line.substr(equal + 1);
  value = value.substr(0, value.find('#'));
  while (!value.empty() && (value.front() == ' ' || value.front() == '\t')) value.remove_prefix(1);
  while (!value.empty() && (value.back() == ' ' || value.back() == '\t')) value.remove_suffix(1);
  std::string dotted(value);
  const auto comma = dotted.find(',');
  if (comma != std::string::npos) {
    dotted[comma] = '.';
    if (parse_number(dotted)) return "a decimal point is a dot: " + dotted;
  }
  if (parse_number(value)) return "write a digit on both sides of the dot, and no zeros in front";
  if (value == "True" || value == "False" || value == "TRUE" || value == "FALSE")
    return value.front() == 'T' ? "write true" : "write false";
  const auto blank = value.find_first_of(" \t");
  if (blank != std::string_view::npos && parse_number(value.substr(0, blank)))
    return "a value is a number alone; the unit is part of the key";
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  if (!value.empty() && std::all_of(value.begin(), value.end(), is_letter))
    return "a text needs quotes: \"" + std::string(value) + "\"";
  return "";
}

/// The first syntax error of the text as a diagnostic, with the line as written in the file.
Diagnostic syntax_error(const toml::parse_error& error, const SourceSet& sources, std::uint32_t file) {
  const std::string_view line = sources[file].line(error.source().begin.line);
  Diagnostic d =
      file_diagnostic(Code::file_syntax, Converter(sources[file].text(), file).span(error.source()),
                      plain_words(error.description()));
  if (d.label.starts_with("cannot redefine existing")) {
    const auto first = line.find_first_not_of(" \t");
    const auto end = std::min(line.find_first_of(" \t=#", first), line.size());
    d.code = Code::file_duplicate_key;
    d.span.column = static_cast<std::uint32_t>(first + 1);
    d.span.length = static_cast<std::uint32_t>(end - first);
    d.label = "is already given above";
    d.help = "keep one of the two";
  } else if (!is_utf8(line)) {
    d.label = "these bytes are not UTF-8";
    d.help = "save the file as UTF-8 (it may be in CP1251)";
  } else {
    d.help = syntax_help(line);
  }
  d.message = code_entry(d.code).title;
  return d;
}

Diagnostic too_deep(const TooDeep& place, std::uint32_t file) {
  const Span span{file, place.line, static_cast<std::uint32_t>(place.begin + 1),
                  static_cast<std::uint32_t>(place.length)};
  const bool key = place.kind == TooDeep::Kind::key;
  Diagnostic d = file_diagnostic(Code::file_too_deep, span,
                                 key ? fmt::format("{} parts", place.levels)
                                     : fmt::format("{} lists or tables within each other", place.levels));
  if (!key) d.message = "lists or tables nested too deep";
  d.notes.push_back(fmt::format("allowed: {}", key ? kMostKeyParts : kMostNestedValues));
  return d;
}

/// Overwrites a 1-based line with blanks, keeping every other place. False if it is not a plain "key = value" line.
bool blank_line(std::string& text, std::uint32_t number) {
  std::size_t begin = 0;
  for (std::uint32_t i = 1; i < number; ++i) {
    const auto end = text.find('\n', begin);
    if (end == std::string::npos) return false;
    begin = end + 1;
  }
  const std::size_t end = std::min(text.find('\n', begin), text.size());
  const auto first = text.find_first_not_of(" \t\r", begin);
  if (first >= end || text[first] == '[') return false;
  std::fill(text.begin() + static_cast<std::ptrdiff_t>(begin),
            text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  return true;
}

}  // namespace

ParsedTree parse_toml(const SourceSet& sources, std::uint32_t file, Diagnostics& diagnostics) {
  ParsedTree tree;
  std::string text(sources[file].text());
  for (int errors = 0; errors < kMaxSyntaxErrors; ++errors) {
    // the parser would take each part of a key as a level of its stack
    if (const auto deep = find_too_deep(text)) {
      tree.complete = false;
      diagnostics.add(too_deep(*deep, file));
      if (!blank_line(text, deep->line)) break;
      continue;
    }
    try {
      const toml::table table = toml::parse(text, sources[file].name());
      tree.root = Converter(sources[file].text(), file).node(table);
      return tree;
    } catch (const toml::parse_error& error) {
      tree.complete = false;
      // an error found only at a line's end, or on the next line, belongs to the text before
      diagnostics.add(syntax_error(error, sources, file));
      if (!blank_line(text, error.source().begin.line)) break;
    }
  }
  tree.root = Node{};
  return tree;
}

Node parse_value(const std::string& value, const Span& span) {
  Node node;
  if (const auto number = parse_number(value)) {
    node.kind = Node::Kind::number;
    node.number = *number;
  } else {
    node.kind = Node::Kind::text;
    node.text = value;
    try {
      const std::string line = "v = " + value;
      const toml::table table = find_too_deep(line) ? toml::table() : toml::parse(line);
      if (table.size() == 1 && value.find('\n') == std::string::npos)
        node = Converter(line, 0).node(*table.get("v"));
    } catch (const toml::parse_error&) {
    }
  }
  const auto set_span = [&span](auto&& self, Node& n) -> void {
    n.span = span;
    for (Node& item : n.items) self(self, item);
    for (Entry& e : n.entries) {
      e.key_span = span;
      self(self, e.value);
    }
  };
  set_span(set_span, node);
  return node;
}

}  // namespace kadr::machine
