#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

/// A case of the storm: a scenario folder, as text.
namespace kadr::storm {

inline constexpr const char* kScenarioFile = "scenario.toml";
inline constexpr const char* kMachineFile = "machine.toml";
inline constexpr const char* kProgramFile = "program.ngc";
inline constexpr const char* kToolsFile = "tools.tbl";
/// A second timeline of the same program; missing: the program without one.
inline constexpr const char* kOtherFile = "other.toml";
/// What the world does to a run of the program kadr; missing: nothing.
inline constexpr const char* kFaultFile = "fault.txt";

struct StormCase {
  std::map<std::string, std::string> files;  ///< name and text

  bool has(const std::string& name) const { return files.contains(name); }
  std::string text(const std::string& name) const {
    const auto it = files.find(name);
    return it == files.end() ? std::string() : it->second;
  }
  /// Lines of all files but README.md.
  std::size_t lines() const;
};

/// Makes the folder where it is missing, and writes the files; others in it stay.
void write_case(const StormCase& storm_case, const std::string& folder);
/// @throws std::runtime_error for a folder that has no scenario
StormCase read_case(const std::string& folder);
std::string read_file(const std::string& path);
void write_file(const std::string& path, const std::string& text);

/// How often something was met, by its name.
using Tally = std::map<std::string, std::int64_t>;

/// What a case has in it, each once: "code G2", "planner.method tube", "axes 3", "dialect grbl", "fault kill".
std::vector<std::string> features_of(const StormCase& storm_case);

/// The case of a seed: the same on every machine.
/// @param with_fault  the world does something to it
StormCase make_case(std::uint64_t seed, bool with_fault);
/// Hash of the texts of the cases of seeds 1 to `last`.
std::uint64_t hash_of_cases(std::uint64_t last);

}  // namespace kadr::storm
