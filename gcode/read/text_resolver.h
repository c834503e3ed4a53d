#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gcode/reading_bounds.h"
#include "machine/base/diagnostic.h"

namespace kadr::gcode {

/// Opens the text of a program, or of a file that it calls.
/// @throws UnreadableText  whose reason names the bound, if it is longer than that
SourceText open_program(const InputFile& file, std::uint64_t most_bytes);

/// Result of looking for the text of a name: a text, a refusal, or neither if there is none.
struct FoundText {
  std::optional<SourceText> text;
  std::string refusal;     ///< why there is one that can't be used
  std::string help;        ///< what would be right; of a refusal
  std::string looked;      ///< where it was looked for, a note for people; where there is none
  bool too_large = false;  ///< the refusal is about its size
};

/// Finds the texts of the files that a program calls.
class TextResolver {
 public:
  virtual ~TextResolver() = default;
  /// @param name  of the subroutine, without ending
  virtual FoundText find(std::string_view name) const = 0;
};

/// Looks for NAME.ngc in folders, in their order. A file counts only if it is a plain file below its folder, or an
/// allowed one, once all links are followed; names that contain a path are refused.
class FolderTexts final : public TextResolver {
 public:
  /// @param most_bytes  larger files are refused; 0: no bound
  /// @param allowed     folders that links may lead to; nothing is looked for there
  explicit FolderTexts(std::vector<std::string> folders,
                       std::uint64_t most_bytes = ReadingBounds().file_bytes,
                       std::vector<std::string> allowed = {})
      : folders_(std::move(folders)), allowed_(std::move(allowed)), most_bytes_(most_bytes) {}
  /// The folder of a program, unless it comes from standard input ("-"), then the others.
  static FolderTexts beside(const std::string& program, const std::vector<std::string>& others,
                            std::uint64_t most_bytes = ReadingBounds().file_bytes,
                            std::vector<std::string> allowed = {});
  FoundText find(std::string_view name) const override;

 private:
  std::vector<std::string> folders_, allowed_;
  std::uint64_t most_bytes_;
};

/// Texts held in memory (dropped files, an editor's buffers). Other names are passed on to another resolver.
class MemoryTexts final : public TextResolver {
 public:
  /// @param behind  outlives this; null: there is no other
  explicit MemoryTexts(const TextResolver* behind = nullptr) : behind_(behind) {}
  /// Adds a text, or replaces it.
  /// @param name  of the subroutine, without ending
  void put(const std::string& name, std::string text) { texts_[name] = std::move(text); }
  FoundText find(std::string_view name) const override;

 private:
  const TextResolver* behind_;
  std::map<std::string, std::string, std::less<>> texts_;
};

}  // namespace kadr::gcode
