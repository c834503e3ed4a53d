#pragma once
#include <sys/stat.h>

namespace kadr {

/// While it lives, this process remembers which files it opens to read and which it makes, so that no output replaces
/// one of them (OutputFile). A program of one run has one from its start; a library that serves many runs has none. One
/// at a time.
class InputMemory {
 public:
  InputMemory();
  InputMemory(const InputMemory&) = delete;
  InputMemory& operator=(const InputMemory&) = delete;
  ~InputMemory();
};

/// Tells that a file was opened to read; whoever opens one calls it. Without an InputMemory it does nothing.
void note_input_file(const struct stat& status);

/// True for a file that was opened to read, by whatever name: device and inode decide.
bool is_input_file(const struct stat& status);

/// The same for a file that was made and has its name.
void note_output_file(const struct stat& status);
bool is_output_file(const struct stat& status);

}  // namespace kadr
