#pragma once
#include <span>
#include <string_view>

namespace kadr::machine {

/// A file of machine/files, embedded at build by machine/CMakeLists.txt.
struct ShippedText {
  std::string_view name;  ///< file name without ".toml"
  std::string_view text;
};
std::span<const ShippedText> shipped_texts();

}  // namespace kadr::machine
