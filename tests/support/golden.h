#pragma once
#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace kadr::test {

/// Compares a text with a golden file whose first line names its generator; rewrites the file instead if
/// KADR_REGENERATE is set.
/// @param generator  the test that makes the text, as a path inside the project
inline void check_golden(const std::string& path, std::string_view generator, const std::string& text) {
  const std::string head = "# written by " + std::string(generator) + "; tools/regenerate rewrites it\n";
  if (std::getenv("KADR_REGENERATE")) std::ofstream(path, std::ios::binary) << head << text;
  std::ifstream in(path, std::ios::binary);
  const std::string golden{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  CAPTURE(path);
  CHECK(golden == head + text);
}

}  // namespace kadr::test
