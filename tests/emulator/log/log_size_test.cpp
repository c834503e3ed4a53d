#include <doctest/doctest.h>

#include <filesystem>

#include "log_support.h"
#include "machine/machine.h"

using namespace kadr;
using namespace kadr::log;
using test::TestFolder;

namespace {

std::int64_t bytes_of(const std::string& path) {
  return static_cast<std::int64_t>(std::filesystem::file_size(path));
}

}  // namespace

TEST_CASE("three axes at 50 kHz with every channel on cost at most 1.5 B a pulse and 250 B a tick") {
  const TestFolder folder;
  constexpr std::int64_t kTicks = 20'000;
  const std::int64_t pulses = test::write_log(folder / "a", test::log_machine(3), kTicks);
  REQUIRE(pulses > 100 * kTicks);
  const double budget = 1.5 * static_cast<double>(pulses) + 250.0 * kTicks;
  CHECK(static_cast<double>(bytes_of(folder / "a")) <= budget);
}

TEST_CASE("three axes at rest with every channel on cost at most 250 B a tick") {
  const TestFolder folder;
  constexpr std::int64_t kTicks = 20'000;
  auto machine = test::log_machine(3);
  REQUIRE(test::write_log(folder / "a", machine, kTicks, {.peak_steps_per_s = 0}) == 0);
  test::write_log(folder / "none", machine, 0, {.peak_steps_per_s = 0});
  // blocks and events are counted apart: 200 KADR_BLOCK, 199 KADR_BLOCK_END, 80 KADR_EVENT of at most 220 B
  CHECK(bytes_of(folder / "a") - bytes_of(folder / "none") <= 250 * kTicks + 479 * 220);
}

TEST_CASE("pulses alone cost 1.0 to 1.5 bytes each from 5 to 200 kHz, ramps and reversals included") {
  const TestFolder folder;
  auto machine = test::log_machine(3);
  machine.log.ticks = false;
  machine.log.viewer_rate_hz = 0;
  for (const double rate : {5e3, 20e3, 50e3, 100e3, 200e3}) {
    const std::int64_t ticks = 8000;
    const std::int64_t pulses = test::write_log(folder / "a", machine, ticks, {.peak_steps_per_s = rate});
    machine.log.steps = false;
    test::write_log(folder / "b", machine, ticks, {.peak_steps_per_s = rate});
    machine.log.steps = true;
    // a KADR_STEPS message costs 110 B around its pulses (envelope 46, fields 64)
    const std::int64_t around = 110 * (ticks / 32);
    const double each = static_cast<double>(bytes_of(folder / "a") - bytes_of(folder / "b") - around) /
                        static_cast<double>(pulses);
    CAPTURE(rate);
    CHECK(each >= 1.0);
    CHECK(each <= 1.5);
  }
}

TEST_CASE("the size estimated before a run is within 15 % of the log") {
  const TestFolder folder;
  struct Case {
    const char* what;
    int axes;
    std::int64_t ticks;
    double rate;
    bool plant;
    double viewer_rate_hz;
    int block_ticks;
    bool log_ticks, log_steps;
  };
  const Case cases[] = {
      {"defaults at 50 kHz", 3, 10'000, 50e3, true, 100, 32, true, true},
      {"at rest", 3, 10'000, 0, true, 100, 32, true, true},
      {"without plant", 3, 10'000, 50e3, false, 100, 32, true, true},
      {"four axes, slow", 4, 5'000, 2e3, true, 100, 32, true, true},
      {"nine axes at 100 kHz", 9, 3'000, 100e3, true, 100, 64, true, true},
      {"viewers only", 3, 10'000, 50e3, true, 1000, 32, false, false},
      {"pulses only", 3, 10'000, 50e3, true, 0, 16, false, true},
      {"ticks only", 1, 10'000, 50e3, true, 0, 16, true, false},
      {"a short run", 3, 50, 50e3, true, 100, 32, true, true},
  };
  for (const Case& c : cases) {
    auto machine = test::log_machine(c.axes);
    machine.log.viewer_rate_hz = c.viewer_rate_hz;
    machine.log.block_ticks = c.block_ticks;
    machine.log.ticks = c.log_ticks;
    machine.log.steps = c.log_steps;
    const std::int64_t pulses =
        test::write_log(folder / "a", machine, c.ticks, {.peak_steps_per_s = c.rate, .plant = c.plant});
    const RunHeader header = test::log_header(machine);
    const std::size_t texts =
        header.program_text.size() + header.machine_toml.size() + header.settings_toml.size();
    const auto estimated =
        static_cast<double>(estimate_log_bytes(machine, static_cast<double>(c.ticks) * 0.001, pulses,
                                               static_cast<std::size_t>(c.ticks / 100), c.plant, texts));
    const auto real = static_cast<double>(bytes_of(folder / "a"));
    CAPTURE(c.what);
    CAPTURE(estimated);
    CAPTURE(real);
    CHECK(estimated >= 0.85 * real);
    CHECK(estimated <= 1.15 * real);
  }
}
