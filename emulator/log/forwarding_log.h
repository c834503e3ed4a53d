#pragma once
#include "emulator/log/run_log.h"

namespace kadr::log {

/// Passes everything from the cycle to a log, which may be missing. A listener overrides the records it needs,
/// and passes them on too.
class ForwardingLog : public RunLog {
 public:
  using Written = tl::expected<void, LogError>;

  /// @param next  outlives this; nullptr: the records end here
  explicit ForwardingLog(RunLog* next) : next_(next) {}
  Written begin(const RunHeader& header) override { return next_ ? next_->begin(header) : Written(); }
  Written block(const BlockRecord& record) override { return next_ ? next_->block(record) : Written(); }
  Written tick(const TickRecord& record, const StepBatch& batch) override {
    return next_ ? next_->tick(record, batch) : Written();
  }
  Written block_end(const BlockEndRecord& record) override {
    return next_ ? next_->block_end(record) : Written();
  }
  Written event(const EventRecord& record) override { return next_ ? next_->event(record) : Written(); }
  Written diagnostic(const Diagnostic& d, Ticks tick) override {
    return next_ ? next_->diagnostic(d, tick) : Written();
  }
  Written end(const RunSummary& summary) override { return next_ ? next_->end(summary) : Written(); }

 private:
  RunLog* next_;
};

}  // namespace kadr::log
