#include "emulator/log/event_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "emulator/log/wire.h"
#include "machine/base/input_files.h"

namespace kadr::log {

tl::expected<EventFile, std::string> EventFile::open(const std::string& path) {
  EventFile events;
  const auto because = [](int number) { return tl::unexpected(std::string(std::strerror(number))); };
  // a FIFO would wait for a writer, and a tape would move
  const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (fd < 0) return because(errno);
  events.file_.reset(::fdopen(fd, "rb"));
  if (!events.file_) {
    const int reason = errno;
    ::close(fd);
    return because(reason);
  }
  struct stat status {};
  if (::fstat(fd, &status) != 0) return because(errno);
  if (!S_ISREG(status.st_mode)) return tl::unexpected(std::string("not a regular file"));
  note_input_file(status);
  events.size_ = status.st_size;
  constexpr std::size_t kBuffer = std::size_t{1} << 18;
  std::setvbuf(events.file_.get(), nullptr, _IOFBF, kBuffer);
  return events;
}

void EventFile::rewind() {
  std::rewind(file_.get());
  position_ = 0;
  number_ = 0;
}

EventFile::Next EventFile::stop(Next why, std::string detail) {
  detail_ = std::move(detail);
  return why;
}

EventFile::Next EventFile::read(void* into, std::size_t bytes) {
  if (std::fread(into, 1, bytes, file_.get()) == bytes) return Next::event;
  if (std::ferror(file_.get()))
    return stop(Next::damaged, fmt::format("reading failed at byte {}", position_));
  return stop(Next::cut, fmt::format("the file became shorter while it was read, at byte {}", position_));
}

EventFile::Next EventFile::next(LogEventView& view) {
  const std::int64_t left = size_ - position_;
  if (left == 0) return Next::end;
  std::uint8_t head[kEventHeaderBytes];
  const std::size_t head_bytes = std::min<std::size_t>(kEventHeaderBytes, static_cast<std::size_t>(left));
  if (const Next got = read(head, head_bytes); got != Next::event) return got;
  // a cut within the sync word still has to begin like one
  const std::uint8_t sync[] = {kEventSync >> 24 & 0xff, kEventSync >> 16 & 0xff, kEventSync >> 8 & 0xff,
                               kEventSync & 0xff};
  if (std::memcmp(head, sync, std::min(head_bytes, sizeof sync)) != 0)
    return stop(Next::damaged, fmt::format("no event begins at byte {}", position_));
  const std::string cut = fmt::format("the event at byte {} is cut off", position_);
  if (head_bytes < kEventHeaderBytes) return stop(Next::cut, cut);

  WireReader wire(head);
  wire.i32();
  view.number = wire.i64();
  view.time_us = wire.i64();
  const std::int32_t channel_bytes = wire.i32();
  const std::int32_t data_bytes = wire.i32();
  if (view.number != number_)
    return stop(Next::damaged, fmt::format("event {} is at byte {}, where event {} is due", view.number,
                                           position_, number_));
  if (channel_bytes < 1 || channel_bytes > static_cast<std::int32_t>(kMaxChannelBytes) || data_bytes < 0)
    return stop(Next::damaged, fmt::format("the event at byte {} has impossible lengths", position_));
  const std::int64_t bytes = static_cast<std::int64_t>(kEventHeaderBytes) + channel_bytes + data_bytes;
  channel_.resize(static_cast<std::size_t>(std::min<std::int64_t>(channel_bytes, left - kEventHeaderBytes)));
  if (const Next got = read(channel_.data(), channel_.size()); got != Next::event) return got;
  view.channel = channel_;
  if (bytes > left) return stop(Next::cut, cut);
  data_.resize(static_cast<std::size_t>(data_bytes));
  if (const Next got = read(data_.data(), data_.size()); got != Next::event) return got;
  view.data = data_;
  position_ += bytes;
  ++number_;
  return Next::event;
}

}  // namespace kadr::log
