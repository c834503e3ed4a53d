#include "emulator/cli/key_list.h"

#include <fmt/format.h>

#include "emulator/cli/exit_codes.h"
#include "emulator/text/text.h"

namespace kadr::cli {
namespace {

using text::Json;

Json keys_json(const std::vector<machine::TableDocument>& tables) {
  Json list = Json::array();
  for (const machine::TableDocument& table : tables) {
    for (const machine::KeyDocument& key : table.keys) {
      Json words = Json::array();
      for (const auto& [word, meaning] : key.words) words.push_back({{"word", word}, {"meaning", meaning}});
      list.push_back({{"table", table.header},
                      {"key", key.name},
                      {"allowed", key.allowed},
                      {"default", key.otherwise},
                      {"meaning", key.sentence},
                      {"words", std::move(words)}});
    }
  }
  return list;
}

}  // namespace

int list_keys(const std::vector<machine::TableDocument>& tables, Console& console) {
  if (console.options().json) {
    console.document(keys_json(tables));
    return kYes;
  }
  using Align = text::TextTable::Align;
  std::string out;
  for (const machine::TableDocument& table : tables) {
    out += fmt::format("{}{}{}\n", out.empty() ? "" : "\n", table.header.empty() ? "" : table.header + "  ",
                       table.sentence);
    text::TextTable text(
        {{"key", Align::left}, {"default", Align::left}, {"takes", Align::left}, {"meaning", Align::left}});
    for (const machine::KeyDocument& key : table.keys) {
      text.add({key.name, key.otherwise, key.words.empty() ? key.allowed : "one of", key.sentence});
      for (const auto& [word, meaning] : key.words) text.add({"", "", "  " + word, meaning});
    }
    out += text.render("  ");
  }
  console.data(out);
  return kYes;
}

}  // namespace kadr::cli
