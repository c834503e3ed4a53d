#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;
using Json = nlohmann::json;

TEST_CASE(
    "kadr teach page writes one file, or says why this build has no page, how to get it, what prints the "
    "same") {
  const Scratch folder;
  const Finished run = call({"teach", "page", "line", "7", "4", "-o", "seven.html"}, folder.path());
  // without a command the same, as teach.html or under the name given; another word is no command
  CHECK(call({"teach"}, folder.path()).code == run.code);
  CHECK(folder.has("teach.html") == (run.code == 0));
  CHECK(call({"teach", "-o", "alone.html"}, folder.path()).code == run.code);
  CHECK(folder.has("alone.html") == (run.code == 0));
  const Finished early = call({"teach", "-o", "early.html", "table", "line", "7", "4"}, folder.path());
  CHECK(early.code == 2);
  CHECK(contains(early.err, "options follow the command"));
  CHECK(call({"teach", "pages"}, folder.path()).code == 2);
  if (run.code == 2) {
    const Json missing = Json::parse(call({"version", "--json"}).out).at("pages").at("teaching");
    REQUIRE(missing.is_string());
    CHECK(contains(missing.get<std::string>(), "; "));
    CHECK(contains(missing.get<std::string>(), "tools/run"));
    CHECK(run.err == "kadr: this build has no teaching page: " + missing.get<std::string>() +
                         ". `kadr teach table` and `kadr teach compare` print the same numbers\n");
    CHECK(!folder.has("seven.html"));
    return;
  }
  CHECK(run.code == 0);
  CHECK(contains(folder.read("seven.html"), "id=\"start\">\"line,7,4\"</script>"));
  const Finished far = call({"teach", "page", "line", "1", "2", "3"}, folder.path());
  CHECK(far.code == 2);
  CHECK(contains(far.err, "the page shows one curve in two axes"));
}

TEST_CASE("kadr teach sweep prints the hash that the page's core has") {
  const Finished run = call({"teach", "sweep"});
  CHECK(run.code == 0);
  CHECK(run.out == "20 000 cases, hash d508b1107e158b18\n");
  const Json j = Json::parse(call({"teach", "sweep", "--cases", "1", "--json"}).out);
  CHECK(j["cases"] == 1);
  CHECK(j["sweep_hash"].get<std::string>().size() == 16);
  CHECK(call({"teach", "sweep", "--cases", "0"}).code == 2);
}
