#include <algorithm>

#include "machine/machine_file.h"
#include "machine/shipped_texts.h"

namespace kadr::machine {

std::string_view shipped_machine(std::string_view name) {
  const auto texts = shipped_texts();
  const auto it =
      std::find_if(texts.begin(), texts.end(), [&](const ShippedText& t) { return t.name == name; });
  return it == texts.end() ? std::string_view() : it->text;
}

std::vector<std::string_view> shipped_machine_names() {
  std::vector<std::string_view> names;
  for (const ShippedText& t : shipped_texts()) names.push_back(t.name);
  return names;
}

}  // namespace kadr::machine
