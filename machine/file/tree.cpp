#include "machine/file/tree.h"

#include <algorithm>
#include <utility>

namespace kadr::machine {

Entry* Node::find(std::string_view key) {
  const auto it = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.key == key; });
  return it == entries.end() ? nullptr : &*it;
}

const Entry* Node::find(std::string_view key) const { return const_cast<Node*>(this)->find(key); }

std::string_view kind_text(Node::Kind kind) {
  switch (kind) {
    case Node::Kind::table:
      return "a table";
    case Node::Kind::array:
      return "a list";
    case Node::Kind::number:
      return "a number";
    case Node::Kind::text:
      return "a text";
    case Node::Kind::boolean:
      return "true or false";
    case Node::Kind::date:
      return "a date or time";
  }
  return "";
}

Diagnostic file_diagnostic(Code code, const Span& span, std::string label) {
  return {code, Severity::error, span, std::string(code_entry(code).title), std::move(label), {}, {}};
}

}  // namespace kadr::machine
