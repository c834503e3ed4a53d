#include "emulator/log/alarm_list.h"

namespace kadr::log {

ForwardingLog::Written AlarmList::event(const EventRecord& record) {
  if (record.kind == EventKind::alarm) {
    ++counts_[record.code];
    if (alarms_.size() < kKept) alarms_.push_back(record);
  }
  return ForwardingLog::event(record);
}

}  // namespace kadr::log
