#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What a file names stays in its folder: a scenario's program, machine and tool table, a problem's table, a program's
/// called files. Whoever reads such a file opens it here.
namespace kadr {

/// The folders below which the files lie that a file may name, once all links are followed.
struct InputFolders {
  std::string own;                        ///< of the file that names them; empty: the current folder
  std::vector<std::string> allowed = {};  ///< those of --allow
  /// "parts, /opt/machines", for people
  std::string text() const;
};

/// A file to read. One that the user names may lie anywhere, one that a file names lies below folders.
struct InputFile {
  std::string path;
  std::optional<InputFolders> folders;

  InputFile(std::string of_user) : path(std::move(of_user)) {}
  InputFile(const char* of_user) : path(of_user) {}
  /// @param name  as the file in the folder `below.own` has it
  InputFile(const std::string& name, InputFolders below);
  /// The same on every machine: as the file that names it has it, or without its folders if the user names it.
  std::string name() const;
};

enum class InputPlace : std::uint8_t { inside, outside, missing };
/// Where a file lies; `missing` if it lies inside and is no regular file. It is not opened.
InputPlace place_of(const InputFile& file);

/// Why a file of InputPlace::missing is none: "there is no file a.ngc", "a.ngc is a pipe, not a file".
std::string missing_text(const InputFile& file);

/// Opens a file to read, without waiting for the writer of a pipe. The file that is opened is the one whose place was
/// looked at: whatever links are put on the way meanwhile.
/// @return the descriptor; -1: errno says why
/// @throws UnreadableText for a file outside its folders
int open_input(const InputFile& file);

/// Opens an absolute path of which no part may be a link.
/// @return the descriptor; -1: errno says why
int open_without_links(const std::string& path);

}  // namespace kadr
