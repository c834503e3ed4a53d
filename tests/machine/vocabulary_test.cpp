#include <doctest/doctest.h>

#include <string>

#include "machine/base/vocabulary.h"
#include "machine/step_method.h"
#include "machine/words.h"

using namespace kadr;

namespace {

enum class Hue : std::uint8_t { red, green, blue };

constexpr Vocabulary<Hue, 3> kHues{
    {{Hue::red, "red", "like blood"}, {Hue::green, "green"}, {Hue::blue, "blue"}}};
static_assert(kHues.complete());

// what must not compile as `static_assert(complete())`
constexpr Vocabulary<Hue, 2> kForgotten{{{Hue::red, "red"}, {Hue::green, "green"}}};
static_assert(kForgotten.in_order() && !kForgotten.complete());
constexpr Vocabulary<Hue, 3> kSwapped{{{Hue::green, "green"}, {Hue::red, "red"}, {Hue::blue, "blue"}}};
static_assert(!kSwapped.complete());
constexpr Vocabulary<Hue, 3> kTwice{{{Hue::red, "red"}, {Hue::green, "red"}, {Hue::blue, "blue"}}};
static_assert(!kTwice.complete());
constexpr Vocabulary<Hue, 4> kInvented{{{Hue::red, "red"}, {Hue::green, "green"}, {Hue::blue, "blue"}, {}}};
static_assert(!kInvented.complete());

}  // namespace

TEST_CASE("a vocabulary spells a value and finds a word") {
  CHECK(kHues.word(Hue::green) == "green");
  CHECK(kHues.sentence(Hue::red) == "like blood");
  CHECK(kHues.find("blue") == Hue::blue);
  CHECK_FALSE(kHues.find("Blue"));
  CHECK_FALSE(kHues.find(""));
  CHECK(kHues.list() == "red, green, blue");
  CHECK(kHues.list("|") == "red|green|blue");
  CHECK(kHues.up_to<Hue::green>().list() == "red, green");
}

TEST_CASE("a part of a vocabulary spells its own values only") {
  constexpr auto kPart = words_where<kHues>([](Hue hue) { return hue != Hue::green; });
  CHECK(kPart.list() == "red, blue");
  CHECK(kPart.word(Hue::blue) == "blue");
  CHECK(kPart.word(Hue::green).empty());
  CHECK_FALSE(kPart.find("green"));
}

TEST_CASE("a stored number is a value of the enumeration, or nothing") {
  CHECK(kHues.at(0) == Hue::red);
  CHECK(kHues.at(2) == Hue::blue);
  CHECK_FALSE(kHues.at(3));
  CHECK_FALSE(kHues.at(-1));
}

TEST_CASE("a stored word that no enumerator has keeps its text") {
  using Stored = StoredWord<kHues>;
  CHECK(Stored::read("green") == Hue::green);
  CHECK(Stored::read("green").text() == "green");
  CHECK(Stored::read("green") == Stored(Hue::green));
  const Stored foreign = Stored::read("violet");
  CHECK(foreign.text() == "violet");
  CHECK_FALSE(foreign.value());
  for (const auto& hue : kHues) CHECK_FALSE(foreign == hue.value);
  CHECK_FALSE(foreign == Stored::read("pink"));
}

TEST_CASE("a machine runs the methods up to ptp; those behind are the laboratory's") {
  CHECK(machine::kMachineMethods.find("ptp") == machine::StepMethod::ptp);
  CHECK_FALSE(machine::kMachineMethods.find("newton"));
  CHECK(machine::kStepMethods.find("newton") == machine::StepMethod::newton);
}
