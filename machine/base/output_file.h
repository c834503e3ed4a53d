#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace kadr {

/// Why an output file can't be written.
struct OutputFault {
  std::string path;
  std::string reason;  ///< strerror(), or a sentence for what kadr refuses
};

struct OutputRules {
  bool overwrite = true;    ///< false: whatever has that name already is refused
  bool keeps_part = false;  ///< PATH.part stays if the file is never finished: what was written can be read
  bool own_input = false;   ///< the file replaces an input of this run on purpose
};

/// The one writer of files.
///
/// A regular file appears under its name when it is whole: it is written as PATH.part, and finish() hands it to the
/// disk and renames it. PATH.part is always a new file, never opened through a link, and locked: two writers of one
/// PATH can't meet, and what a killed one left behind is replaced. A symbolic link stays a link; the file that it
/// names is replaced. Permissions and, where allowed, owner of a replaced file are kept.
///
/// A pipe, a FIFO and a character device are written into as they are, and so is whatever this process has as
/// standard output or standard error; `-` is standard output. A terminal gets what a terminal may be shown
/// (machine/base/terminal_text.h). Folders, sockets, block devices and files that the process has read
/// or made (InputMemory) are refused.
class OutputFile {
 public:
  using Done = tl::expected<void, OutputFault>;

  static tl::expected<OutputFile, OutputFault> open(const std::string& path, OutputRules rules = {});
  OutputFile(OutputFile&&) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();  ///< without finish() nothing gets the name

  /// Appends; large pieces reach the kernel on their own. After a fault every call gives that fault again.
  Done write(std::string_view bytes);
  /// Hands everything to the kernel: a kill from now on leaves it readable in PATH.part.
  Done flush();
  /// Hands everything to the disk and gives the file its name.
  Done finish();
  /// Hands everything to the disk and keeps it as PATH.part.
  Done leave();

 private:
  explicit OutputFile(std::string path, OutputRules rules) : path_(std::move(path)), rules_(rules) {}
  /// @return false with errno if it can't be written
  bool put(std::string_view bytes) noexcept;
  std::optional<OutputFault> open_part(std::string file, unsigned mode);
  std::optional<OutputFault> open_stream(int descriptor);
  Done check_name();
  Done fail(int number);
  Done fail(const std::string& where, std::string reason);
  Done close();

  std::string path_;  ///< as the user gave it
  OutputRules rules_;
  std::string file_;  ///< with links followed; empty for a pipe or device
  std::string part_;
  int fd_ = -1;
  bool terminal_ = false;
  std::string buffer_;
  std::optional<OutputFault> fault_;
};

/// Where the bytes of an output are before it has its name: "PATH.part" with links followed, or PATH itself for what
/// is written into as it is.
std::string written_as(const std::string& path);

/// Why OutputFile::open() would refuse `path`; nothing is opened or made.
std::optional<OutputFault> output_refusal(const std::string& path, OutputRules rules = {});

/// True if `path` is what this process has as standard output.
bool is_standard_output(const std::string& path);
/// The same of standard error.
bool is_standard_error(const std::string& path);

}  // namespace kadr
