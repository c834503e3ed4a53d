#pragma once
#include <cstdint>
#include <string>
#include <vector>

/// A log as its events, to be changed and put together again: bytes only, so that they may be of any kadr.
namespace kadr::test {

struct LogEvent {
  std::string channel;
  std::int64_t time_us = 0;
  std::vector<std::uint8_t> data;
};

/// The whole events at the beginning of a log.
std::vector<LogEvent> events_of(const std::vector<std::uint8_t>& log);
/// A log of these events, numbered from 0.
std::vector<std::uint8_t> log_of(const std::vector<LogEvent>& events);
/// Gives the summary the hashes of the events, so that only what messages say of each other is left to find.
void seal(std::vector<LogEvent>& events);

}  // namespace kadr::test
