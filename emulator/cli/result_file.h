#pragma once
#include <string>
#include <string_view>

#include "machine/base/output_file.h"

namespace kadr::cli {

/// An output of a command (machine/base/output_file.h) whose faults are WorldErrors with path and reason.
class ResultFile {
 public:
  explicit ResultFile(const std::string& path, OutputRules rules = {});
  void write(std::string_view text);
  /// Gives the file its name.
  void close();

 private:
  OutputFile file_;
};

/// An output's name for people: "standard output" for `-`.
std::string output_text(const std::string& path);

/// Writes a whole text to a file.
/// @throws WorldError with path and reason; that of a file that may not be overwritten names --force
void write_file(const std::string& path, std::string_view text, OutputRules rules = {});

}  // namespace kadr::cli
