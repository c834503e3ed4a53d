#include "emulator/report/alarm_list.h"

namespace kadr::emulator {

using Written = tl::expected<void, LogError>;

Written AlarmList::begin(const RunHeader& header) { return next_ ? next_->begin(header) : Written(); }
Written AlarmList::block(const BlockRecord& record) { return next_ ? next_->block(record) : Written(); }
Written AlarmList::tick(const TickRecord& record, const StepBatch& batch) {
  return next_ ? next_->tick(record, batch) : Written();
}
Written AlarmList::block_end(const BlockEndRecord& record) {
  return next_ ? next_->block_end(record) : Written();
}
Written AlarmList::event(const EventRecord& record) {
  if (record.kind == "alarm") {
    ++counts_[record.code];
    if (alarms_.size() < kKept) alarms_.push_back(record);
  }
  return next_ ? next_->event(record) : Written();
}
Written AlarmList::diagnostic(const Diagnostic& d, Ticks tick) {
  return next_ ? next_->diagnostic(d, tick) : Written();
}
Written AlarmList::end(const RunSummary& summary) { return next_ ? next_->end(summary) : Written(); }

}  // namespace kadr::emulator
