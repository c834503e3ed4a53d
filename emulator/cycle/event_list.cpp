#include "emulator/cycle/event_list.h"

#include "planner/path/path.h"

namespace kadr::cycle {

std::uint32_t EventList::block() const { return path_.size() > 0 ? path_.segments[segment_].block : 0; }

std::uint32_t EventList::line() const { return path_.size() > 0 ? path_.segments[segment_].span.line : 0; }

log::EventRecord& EventList::add_at(std::size_t segment, Ticks tick, log::EventKind kind) {
  log::EventRecord& event = list_.emplace_back();
  event.tick = tick;
  event.kind = kind;
  if (path_.size() > 0) {
    event.block = path_.segments[segment].block;
    event.span = path_.segments[segment].span;
  }
  return event;
}

void EventList::alarm(Ticks tick, Code code, double value, double limit, std::string text) {
  log::EventRecord& event = add(tick, log::EventKind::alarm);
  event.code = code;
  event.value = value;
  event.limit = limit;
  event.text = std::move(text);
}

}  // namespace kadr::cycle
