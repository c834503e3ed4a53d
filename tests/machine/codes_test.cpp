#include "machine/base/codes.h"

#include <doctest/doctest.h>

#include <string>

using namespace kadr;

TEST_CASE("every code has a title without full stop and an explanation of at least 60 characters") {
  CHECK(all_codes().size() > 20);
  for (const CodeEntry& e : all_codes()) {
    CAPTURE(code_name(e.code));
    REQUIRE_FALSE(e.title.empty());
    CHECK(e.title.back() != '.');
    CHECK(e.title.size() <= 72);
    CHECK(e.explanation.size() >= 60);
    CHECK(e.explanation.find("  ") == std::string_view::npos);
  }
}

TEST_CASE("codes ascend, none is given twice, and each lies in K1xxx to K5xxx or K9xxx") {
  int last = 0;
  for (const CodeEntry& e : all_codes()) {
    const int number = static_cast<int>(e.code);
    CAPTURE(number);
    CHECK(number > last);
    CHECK(((number >= 1000 && number < 6000) || (number >= 9000 && number < 10000)));
    last = number;
  }
}

// each range is listed in one file; the same files, read one by one, tell which code stands in which
#define KADR_CODE(number, name, title, explanation) +(number / 1000 == kRange ? 1 : 1000)
namespace {
namespace reading {
constexpr int kRange = 1;
constexpr int kSum = 0
#include "machine/base/codes/reading.inc"
    ;
}  // namespace reading
namespace geometry {
constexpr int kRange = 2;
constexpr int kSum = 0
#include "machine/base/codes/geometry.inc"
    ;
}  // namespace geometry
namespace files {
constexpr int kRange = 3;
constexpr int kSum = 0
#include "machine/base/codes/files.inc"
    ;
}  // namespace files
namespace planning {
constexpr int kRange = 4;
constexpr int kSum = 0
#include "machine/base/codes/planning.inc"
    ;
}  // namespace planning
namespace motion {
constexpr int kRange = 5;
constexpr int kSum = 0
#include "machine/base/codes/motion.inc"
    ;
}  // namespace motion
namespace internal {
constexpr int kRange = 9;
constexpr int kSum = 0
#include "machine/base/codes/internal.inc"
    ;
}  // namespace internal
}  // namespace
#undef KADR_CODE

TEST_CASE("each code stands in the file of its range") {
  // a code of another range would count 1000
  for (const int sum :
       {reading::kSum, geometry::kSum, files::kSum, planning::kSum, motion::kSum, internal::kSum})
    CHECK(sum < 1000);
  CHECK(files::kSum >= 23);
  CHECK(static_cast<std::size_t>(reading::kSum + geometry::kSum + files::kSum + planning::kSum +
                                 motion::kSum + internal::kSum) == all_codes().size());
}

TEST_CASE("a code is read with or without its K, and nothing else is a code") {
  CHECK(parse_code("K9001") == Code::broken_promise);
  CHECK(parse_code("k9001") == Code::broken_promise);
  CHECK(parse_code("9001") == Code::broken_promise);
  CHECK(code_name(Code::broken_promise) == "K9001");
  for (const char* bad : {"", "K", "K900", "K90011", "K9001x", "X9001", "-9001", "K0000"})
    CHECK_MESSAGE(!parse_code(bad), bad);
}
