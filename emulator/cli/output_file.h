#pragma once
#include <cstdio>
#include <string>
#include <string_view>

namespace kadr::cli {

/// A file that appears when it is whole: written as PATH.part, renamed by close(). Everything throws
/// WorldError with path and reason.
class OutputFile {
 public:
  explicit OutputFile(std::string path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();  ///< removes a file that was not closed

  void write(std::string_view text);
  void close();

 private:
  [[noreturn]] void fail();

  std::string path_, part_;
  std::FILE* file_;
};

}  // namespace kadr::cli
