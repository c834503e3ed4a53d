#pragma once
#include <string>

/// Every reader of a log over one file.
namespace kadr::fuzz {

/// What the readers gave, for a comparison with those of another log.
struct LogAnswers {
  bool sound = false;  ///< a reader said yes
  std::string text;    ///< all outputs; empty unless sound
};

/// Runs info, exports, plots, page, comparison and both kinds of diff.
/// @param other  a true log, for diffs and comparison
/// A broken promise throws.
LogAnswers read_log(const std::string& path, const std::string& other);

/// A file in memory that readers open by its path.
class MemoryFile {
 public:
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  void write(const void* data, std::size_t size);
  const std::string& path() const { return path_; }

 private:
  int file_;
  std::string path_;
};

}  // namespace kadr::fuzz
