#pragma once
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log/log_reader.h"

namespace kadr::log {

/// The events of an LCM log file, one after the other, every length checked against the file before it is believed.
class EventFile {
 public:
  enum class Next : std::uint8_t { event, end, cut, damaged };

  /// @return the reason (strerror) why the file can't be read
  static tl::expected<EventFile, std::string> open(const std::string& path);
  /// Reads the next event into `view`, which stays valid until the next call.
  Next next(LogEventView& view);
  /// Back to the first event.
  void rewind();
  std::int64_t size() const { return size_; }            ///< bytes in the file when it was opened
  std::int64_t position() const { return position_; }    ///< end of the last whole event
  const std::string& detail() const { return detail_; }  ///< after cut or damaged: a sentence

 private:
  struct Close {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  Next stop(Next why, std::string detail);
  Next read(void* into, std::size_t bytes);

  std::unique_ptr<std::FILE, Close> file_;
  std::int64_t size_ = 0;
  std::int64_t position_ = 0;
  std::int64_t number_ = 0;  // of the next event
  std::string channel_;
  std::vector<std::uint8_t> data_;
  std::string detail_;
};

}  // namespace kadr::log
