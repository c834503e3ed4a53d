#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "emulator/log/log_types.h"
#include "emulator/log/pulse_code.h"
#include "log_support.h"

/// The log as docs/log_format.md describes it.
using namespace kadr;
using namespace kadr::emulator;

namespace {

std::string document() {
  std::ifstream in(KADR_SOURCE_DIR "/docs/log_format.md");
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Output of a shell command, with its exit status.
std::pair<int, std::string> run(const std::string& command) {
  std::string out;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (!pipe) return {-1, out};
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    out.append(buffer.data(), n);
  return {::pclose(pipe), out};
}

}  // namespace

TEST_CASE("docs/log_format.md names every channel with its type's fingerprint") {
  const std::string text = document();
  const std::array<std::pair<MessageKind, std::string>, 10> rows{
      {{MessageKind::run, "| `KADR_RUN` | `run_t` |"},
       {MessageKind::block, "| `KADR_BLOCK` | `block_t` |"},
       {MessageKind::block_end, "| `KADR_BLOCK_END` | `block_end_t` |"},
       {MessageKind::ticks, "| `KADR_TICKS` | `ticks_t` |"},
       {MessageKind::steps, "| `KADR_STEPS` | `steps_t` |"},
       {MessageKind::feed, "| `KADR_FEED` | `feed_t` |"},
       {MessageKind::axis, "| `KADR_AXIS_X` ... | `axis_t` |"},
       {MessageKind::event, "| `KADR_EVENT` | `event_t` |"},
       {MessageKind::diag, "| `KADR_DIAG` | `diag_t` |"},
       {MessageKind::summary, "| `KADR_SUMMARY` | `summary_t` |"}}};
  for (const auto& [kind, row] : rows) {
    const std::string line = fmt::format("{} {:016x} |", row, static_cast<std::uint64_t>(fingerprint(kind)));
    CAPTURE(line);
    CHECK(text.find(line) != std::string::npos);
  }
}

TEST_CASE("the pulse code example of docs/log_format.md is what the encoder writes") {
  PulseEncoder encoder;
  encoder.begin_block();
  AxisPulses p;
  p.offset_ticks = {0, 1, 2};
  p.first_sign = -1;
  encoder.add(p, 0);
  p.first_sign = 1;
  p.reversals = {2};
  encoder.add(p, 6);
  std::vector<std::uint8_t> code;
  encoder.finish_block(code);
  std::string line = "    code    ";
  for (std::size_t i = 0; i < code.size(); ++i)
    line += fmt::format("{}{:02x}",
                        i < 6    ? "  " + std::string(i == 0 ? 1 : 0, ' ')
                        : i == 6 ? "         "
                                 : " ",
                        code[i]);
  CAPTURE(line);
  CHECK(document().find(line) != std::string::npos);
}

TEST_CASE("the Python decoder of docs/log_format.md finds every pulse of a log") {
  const std::string text = document();
  const std::size_t begin = text.find("```python\n"), end = text.find("```", begin + 3);
  REQUIRE(begin != std::string::npos);
  REQUIRE(end != std::string::npos);
  const test::TestFolder folder;
  std::ofstream(folder / "decode.py") << text.substr(begin + 10, end - begin - 10);
  const auto machine = test::log_machine(3);
  test::write_log(folder / "a.lcmlog", machine, 2500);

  test::FakeRun fake(machine);
  std::array<std::int64_t, 3> count{}, net{}, last{};
  for (std::int64_t k = 0; k < 2500; ++k) {
    fake.advance();
    for (std::size_t a = 0; a < 3; ++a) {
      const AxisPulses& p = fake.batch().axis[a];
      count[a] += static_cast<std::int64_t>(p.count());
      net[a] += p.net_steps().value;
      if (p.count() > 0) last[a] = k * 10'000 + p.offset_ticks.back();
    }
  }
  std::string expected;
  for (std::size_t a = 0; a < 3; ++a) expected += fmt::format("{} {} {} {}\n", a, count[a], net[a], last[a]);

  if (run("python3 --version 2>/dev/null").first != 0) {
    MESSAGE("not tested: this host has no python3");
    return;
  }
  const auto [status, out] = run(fmt::format("python3 '{}' '{}'", folder / "decode.py", folder / "a.lcmlog"));
  CHECK(status == 0);
  CHECK(out == expected);
}
