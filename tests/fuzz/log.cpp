#include <algorithm>
#include <cstring>

#include "checks.h"
#include "log_mutations.h"
#include "log_readers.h"
#include "tests/emulator/log/log_events.h"

/// Logs: whatever the bytes, every reader gives a sound answer or says what is wrong.
namespace {

using namespace kadr;

constexpr std::size_t kMaxLog_bytes = 65536;

const fuzz::Bytes& true_log() {
  static const fuzz::Bytes log = fuzz::true_logs().front();
  return log;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kMaxLog_bytes) return 0;
  static fuzz::MemoryFile file, other;
  static const bool written = (other.write(true_log().data(), true_log().size()), true);
  if (!written) return 0;
  file.write(data, size);
  fuzz::read_log(file.path(), other.path());
  return 0;
}

/// libFuzzer asks for inputs here: changes of a log as a sequence, with hashes that fit in most of them.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  fuzz::Chance chance(seed);
  const fuzz::Bytes given(data, data + size);
  const fuzz::Bytes& base = test::events_of(given).empty() ? true_log() : given;
  const fuzz::Bytes log = fuzz::mutated(base, chance).log;
  const std::size_t kept = std::min(log.size(), max_size);
  std::memcpy(data, log.data(), kept);
  return kept;
}
