#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <tuple>

#include "emulator/scenario/scenario_keys.h"

using namespace kadr;
using namespace kadr::scenario;

namespace {

/// A section of scenarios/README.md: a row for each key, as it is declared.
class KeyTable {
 public:
  void header(std::string_view table) {
    out_ += fmt::format("\n{}\n\n| key | takes | meaning |\n|---|---|---|\n", table);
  }
  void row(std::string_view name, std::string_view takes, std::string_view sentence) {
    out_ += fmt::format("| `{}` | {} | {} |\n", name, takes, sentence);
  }
  template <class Keys>
  void rows(const Keys& keys) {
    for (const auto& key : keys) add(key);
  }
  template <class... Keys>
  void rows(const std::tuple<Keys...>& keys) {
    std::apply([&](const auto&... key) { (add(key), ...); }, keys);
  }
  void add(const NumberKey& key) { row(key.name, machine::bounds_text(key.bounds, key.name), key.sentence); }
  static std::string takes(std::string_view allowed, std::string_view otherwise) {
    if (otherwise.empty()) return std::string(allowed);
    return fmt::format("{}; {}{}", allowed, otherwise.starts_with("required") ? "" : "default: ", otherwise);
  }
  void add(const machine::PlainKey& key) { row(key.name, takes(key.allowed, key.otherwise), key.sentence); }
  template <class Model, class Value>
  void add(const machine::Key<Model, Value>& key) {
    const machine::KeyDocument d = machine::document(key);
    row(d.name, takes(d.allowed, d.otherwise), d.sentence);
  }
  void add(const ActionKey& key) {
    row(key.name,
        key.takes == ActionKey::Takes::flag ? std::string("true")
                                            : machine::bounds_text(key.bounds, key.name),
        key.sentence);
  }
  void add(const RangeKey& key) {
    row(fmt::format("{}, {}", key.linear, key.rotary), "[least, most]", key.sentence);
  }
  const std::string& text() const { return out_; }

 private:
  std::string out_;
};

std::string key_section() {
  KeyTable t;
  t.header("In front of all tables:");
  t.add(kScenarioFormat);
  t.rows(kScenarioTexts);
  t.add(kMostOverride);
  t.add(kFromLine);
  t.add(kToLine);
  t.header("`[hal]`:");
  t.add(kHal);
  t.header("`[[technology]]`, beside the keys of the machine file:");
  t.rows(kTechnologyKeys);
  t.header("`[[step]]`: a time or place,");
  t.rows(kMomentKeys);
  t.header("one action,");
  t.rows(kActionKeys);
  t.header("and what some actions take:");
  t.rows(kActionNumbers);
  t.header("`[expect]`:");
  t.rows(kExpectNumbers);
  t.rows(kExpectTexts);
  t.header("`[[expect.signal]]`, one of least and most at least:");
  t.add(kSignalName);
  t.rows(kSignalKeys);
  t.header("`[[expect.boundary]]`:");
  t.rows(kBoundaryKeys);
  t.header("`[expect.axis.X]`:");
  t.rows(kAxisCounts);
  t.rows(kAxisRanges);
  return t.text();
}

}  // namespace

TEST_CASE("scenarios/README.md lists every key of a scenario as it is declared") {
  const std::string path = std::string(KADR_SOURCE_DIR) + "/scenarios/README.md";
  std::ifstream in(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::string head = "## Keys\n", next = "\n## Windings\n";
  const std::size_t begin = text.find(head), end = text.find(next);
  REQUIRE(begin != text.npos);
  REQUIRE(end != text.npos);
  const std::size_t first = begin + head.size();
  if (std::getenv("KADR_REGENERATE")) {
    text.replace(first, end - first, key_section());
    std::ofstream(path, std::ios::binary) << text;
    return;
  }
  CHECK(text.substr(first, end - first) == key_section());
}
