#include "gcode/read/tree.h"

#include <algorithm>

#include "gcode/read/scanner.h"
#include "machine/base/require.h"

namespace kadr::gcode {
namespace {

/// The bytes of an expression's own signs and numbers, in no particular order.
void collect(const Line& line, const Item& item, std::int32_t end_node, std::vector<Bytes>& lexemes) {
  if (item.first < 0) return;
  for (std::int32_t i = item.first; i < end_node; ++i) {
    const ExpressionNode& node = line.nodes[static_cast<std::size_t>(i)];
    lexemes.push_back(node.own);
    if (node.closing.end > node.closing.begin) lexemes.push_back(node.closing);
  }
}

std::vector<Bytes> lexemes_of(const Line& line) {
  std::vector<Bytes> lexemes;
  for (std::size_t i = 0; i < line.items.size(); ++i) {
    const Item& item = line.items[i];
    const std::int32_t end_node = item.first < 0 ? -1 : node_end(line, i);
    const std::uint32_t begin = item.bytes.begin;
    switch (item.kind) {
      case ItemKind::word:
        lexemes.push_back({begin, begin + 1});
        if (is_corner(item) && item.value >= 0) {
          // , and its letter
          const std::size_t letter = line.text.find_first_of("RCrc", begin);
          lexemes.push_back({static_cast<std::uint32_t>(letter), static_cast<std::uint32_t>(letter) + 1});
        }
        if (item.value < 0) lexemes.push_back({begin + 1, item.bytes.end});
        collect(line, item, end_node, lexemes);
        break;
      case ItemKind::o_word:
        lexemes.push_back(line.flow.label_root < 0 ? line.flow.label : Bytes{begin, begin + 1});
        if (line.flow.keyword.end > 0) lexemes.push_back(line.flow.keyword);
        collect(line, item, end_node, lexemes);
        break;
      case ItemKind::control:
        lexemes.push_back(line.flow.keyword);
        for (const Bytes more : {line.flow.second, line.flow.label})
          if (more.end > 0) lexemes.push_back(more);
        collect(line, item, end_node, lexemes);
        break;
      case ItemKind::setting:
        lexemes.push_back({begin, item.name < 0 ? begin + 1 : item.equals});
        lexemes.push_back({item.equals, item.equals + 1});
        collect(line, item, end_node, lexemes);
        break;
      case ItemKind::comment:
      case ItemKind::line_comment:
      case ItemKind::percent:
      case ItemKind::block_delete:
      case ItemKind::byte_order_mark:
      case ItemKind::unread:
        lexemes.push_back(item.bytes);
        break;
    }
  }
  std::sort(lexemes.begin(), lexemes.end(), [](Bytes a, Bytes b) { return a.begin < b.begin; });
  return lexemes;
}

/// Blanks between two lexemes; the parser lost anything else there.
void append_blanks(std::string& out, std::string_view gap) {
  for (const char c : gap) require(is_blank(c), "every byte of a line that is not blank belongs to an item");
  out += gap;
}

}  // namespace

std::int32_t node_end(const Line& line, std::size_t item) {
  for (std::size_t next = item + 1; next < line.items.size(); ++next)
    if (line.items[next].first >= 0) return line.items[next].first;
  return static_cast<std::int32_t>(line.nodes.size());
}

void append_source(std::string& out, const Line& line) {
  std::uint32_t at = 0;
  for (const Bytes lexeme : lexemes_of(line)) {
    require(lexeme.begin >= at, "lexemes of a line do not overlap");
    append_blanks(out, line.text.substr(at, lexeme.begin - at));
    out += line.slice(lexeme);
    at = lexeme.end;
  }
  append_blanks(out, line.text.substr(at));
  out += line.ending;
}

}  // namespace kadr::gcode
