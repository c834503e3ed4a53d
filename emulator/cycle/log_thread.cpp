#include "emulator/cycle/log_thread.h"

#include <array>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <variant>
#include <vector>

namespace kadr::cycle {
namespace {

/// A tick record with everything it points to.
struct OwnedTick {
  log::TickRecord record;
  TickMotion motion;
  std::vector<Steps> position_steps;
  std::vector<AxisState> axis;
  bool has_plant = false;
  StepBatch batch;
};

using SmallRecord = std::variant<log::BlockRecord, log::BlockEndRecord, log::EventRecord>;

/// Up to kBlockTicks ticks with the other records that came before each of them, in order.
struct RecordBlock {
  static constexpr std::size_t kBlockTicks = 64;
  std::vector<OwnedTick> ticks = std::vector<OwnedTick>(kBlockTicks);
  std::array<std::size_t, kBlockTicks + 1> small_before{};  // small records before tick i; last: all
  std::vector<SmallRecord> small;
  std::size_t count = 0;
};

class ThreadedLog final : public log::RunLog {
 public:
  explicit ThreadedLog(log::RunLog& inner) : inner_(inner), worker_([this] { work(); }) {}
  ~ThreadedLog() override { stop(); }

  tl::expected<void, log::LogError> begin(const log::RunHeader& header) override {
    return inner_.begin(header);
  }

  tl::expected<void, log::LogError> block(const log::BlockRecord& r) override { return add_small(r); }
  tl::expected<void, log::LogError> block_end(const log::BlockEndRecord& r) override { return add_small(r); }
  tl::expected<void, log::LogError> event(const log::EventRecord& r) override { return add_small(r); }

  tl::expected<void, log::LogError> tick(const log::TickRecord& record, const StepBatch& batch) override {
    RecordBlock& block = ring_[head_ % kRing];
    block.small_before[block.count] = block.small.size();
    OwnedTick& t = block.ticks[block.count++];
    t.record = record;
    t.motion = *record.motion;
    t.position_steps = *record.position_steps;
    t.has_plant = record.axis != nullptr;
    if (record.axis) t.axis = *record.axis;
    t.batch = batch;
    return block.count == RecordBlock::kBlockTicks ? hand_over() : status();
  }

  tl::expected<void, log::LogError> diagnostic(const Diagnostic& d, Ticks tick) override {
    if (auto done = drain(); !done) return done;
    return inner_.diagnostic(d, tick);
  }

  tl::expected<void, log::LogError> end(const log::RunSummary& summary) override {
    if (auto done = drain(); !done) return done;
    stop();
    return inner_.end(summary);
  }

 private:
  static constexpr std::size_t kRing = 8;

  template <class R>
  tl::expected<void, log::LogError> add_small(const R& record) {
    ring_[head_ % kRing].small.emplace_back(record);
    return status();
  }

  tl::expected<void, log::LogError> status() {
    if (!failed_.load(std::memory_order_acquire)) return {};
    if (thrown_) std::rethrow_exception(thrown_);
    return tl::unexpected(*error_);
  }

  /// Gives the filled block to the worker and takes the next free one.
  tl::expected<void, log::LogError> hand_over() {
    RecordBlock& block = ring_[head_ % kRing];
    block.small_before[block.count] = block.small.size();
    std::unique_lock lock(mutex_);
    ++head_;
    ready_.notify_one();
    free_.wait(lock, [&] { return head_ - tail_ < kRing; });
    lock.unlock();
    RecordBlock& next = ring_[head_ % kRing];
    next.count = 0;
    next.small.clear();
    return status();
  }

  tl::expected<void, log::LogError> drain() {
    if (auto done = hand_over(); !done) return done;
    std::unique_lock lock(mutex_);
    free_.wait(lock, [&] { return head_ == tail_; });
    return status();
  }

  void stop() {
    if (!worker_.joinable()) return;
    {
      std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    ready_.notify_one();
    worker_.join();
  }

  void work() {
    for (;;) {
      std::unique_lock lock(mutex_);
      ready_.wait(lock, [&] { return stopping_ || tail_ < head_; });
      if (tail_ == head_) return;
      lock.unlock();
      if (!failed_.load(std::memory_order_relaxed)) write(ring_[tail_ % kRing]);
      lock.lock();
      ++tail_;
      free_.notify_one();
    }
  }

  /// What `inner` throws comes back at one of the next calls, as its errors do.
  void write(RecordBlock& block) {
    try {
      hand_on(block);
    } catch (...) {
      thrown_ = std::current_exception();
      failed_.store(true, std::memory_order_release);
    }
  }

  void hand_on(RecordBlock& block) {
    std::size_t small = 0;
    for (std::size_t i = 0; i <= block.count; ++i) {
      for (; small < block.small_before[i]; ++small)
        if (!keep(std::visit([&](const auto& r) { return forward(r); }, block.small[small]))) return;
      if (i == block.count) break;
      OwnedTick& t = block.ticks[i];
      t.record.motion = &t.motion;
      t.record.position_steps = &t.position_steps;
      t.record.axis = t.has_plant ? &t.axis : nullptr;
      if (!keep(inner_.tick(t.record, t.batch))) return;
    }
  }

  tl::expected<void, log::LogError> forward(const log::BlockRecord& r) { return inner_.block(r); }
  tl::expected<void, log::LogError> forward(const log::BlockEndRecord& r) { return inner_.block_end(r); }
  tl::expected<void, log::LogError> forward(const log::EventRecord& r) { return inner_.event(r); }

  bool keep(const tl::expected<void, log::LogError>& done) {
    if (done) return true;
    error_ = done.error();
    failed_.store(true, std::memory_order_release);
    return false;
  }

  log::RunLog& inner_;
  std::array<RecordBlock, kRing> ring_;
  std::mutex mutex_;
  std::condition_variable ready_, free_;
  std::size_t
      head_ = 0,
      tail_ = 0;  // blocks handed over, blocks written; guarded by mutex_ (head_ is read freely by its owner)
  bool stopping_ = false;
  std::atomic<bool> failed_{false};
  std::optional<log::LogError> error_;
  std::exception_ptr thrown_;
  std::thread worker_;
};

}  // namespace

std::unique_ptr<log::RunLog> make_threaded_log(log::RunLog& inner) {
  return std::make_unique<ThreadedLog>(inner);
}

}  // namespace kadr::cycle
