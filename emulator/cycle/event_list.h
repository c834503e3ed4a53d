#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "emulator/log/records.h"

namespace kadr::planner {
class Path;
}

namespace kadr::cycle {

/// Events of the current control tick, in the order in which they are made. Each one is of the block and
/// the program line where the run is.
class EventList {
 public:
  /// @param path  outlives this
  explicit EventList(const planner::Path& path) : path_(path) {}
  /// Events from now on belong to this segment.
  void move_to(std::size_t segment) { segment_ = segment; }
  std::size_t segment() const { return segment_; }
  /// Block of that segment; 0 where the program moves nothing.
  std::uint32_t block() const;
  /// Program line of that segment; 0 where the program moves nothing.
  std::uint32_t line() const;

  /// A new event at the segment where the run is; the caller fills in the rest.
  /// @return valid until the next event
  log::EventRecord& add(Ticks tick, log::EventKind kind) { return add_at(segment_, tick, kind); }
  /// A new event at another segment.
  log::EventRecord& add_at(std::size_t segment, Ticks tick, log::EventKind kind);
  /// An alarm at the segment where the run is, of no axis.
  void alarm(Ticks tick, Code code, double value, double limit, std::string text);
  /// An event that names its own position, or none.
  void append(log::EventRecord event) { list_.push_back(std::move(event)); }

  const std::vector<log::EventRecord>& list() const { return list_; }
  void clear() { list_.clear(); }

 private:
  const planner::Path& path_;
  std::size_t segment_ = 0;
  std::vector<log::EventRecord> list_;
};

}  // namespace kadr::cycle
