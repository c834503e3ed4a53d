#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "machine/base/diagnostic.h"
#include "machine/machine.h"

/// Machine files: read, shipped, printed.
namespace kadr::machine {

/// Where a value comes from: its key as in a setting ("axis.X.max_mm_s") and "mill3.toml:42" or "command line".
struct KeyOrigin {
  std::string key;
  std::string origin;
};

/// A machine file that was read, with the text its spans point to.
struct MachineFile {
  MachineModel model;
  std::string text;
  /// values that were given, in the order of reading; all others are defaults
  std::vector<KeyOrigin> origins = {};
};

/// Reads a machine file (TOML; docs in machine/files/mill3.toml). All mistakes of the file are reported at once.
/// @param sources   the text is added here, so that diagnostics can be rendered
/// @param overrides "key=value" settings from the command line, same keys as in the file
tl::expected<MachineFile, Diagnostics> read_machine(SourceText text, SourceSet& sources,
                                                    const std::vector<std::string>& overrides = {});

/// A machine that ships with kadr: "mill3", "winder4", "rig1", "robot7"; empty text if there is none of that name.
std::string_view shipped_machine(std::string_view name);
std::vector<std::string_view> shipped_machine_names();

/// Every value in force with its origin (file:line, default, command line), as TOML with comments.
std::string render_machine(const MachineFile& file);

/// A key of a machine file, for people.
struct KeyDocument {
  std::string name;       ///< "max_mm_s, max_deg_s"
  std::string allowed;    ///< "1e-06 to 1e+09 mm/s", "true or false"; empty for words
  std::string otherwise;  ///< default, "required"
  std::string sentence;
  /// Words with their sentences.
  std::vector<std::pair<std::string, std::string>> words = {};
};

/// The keys of one table.
struct TableDocument {
  std::string header;  ///< "[planner]"; empty for the keys before all tables
  std::string sentence;
  std::vector<KeyDocument> keys;
};

/// Every key of a machine file, table by table, as it is read.
std::vector<TableDocument> machine_keys();

}  // namespace kadr::machine
