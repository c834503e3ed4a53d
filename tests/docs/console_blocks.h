#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/// Documents whose examples are run: fenced blocks marked ```console with "$ command" and the output below
/// it.
///   "> " after a command continues it; "[..]" in a line stands for any text; a line "[...]" alone for any
///   lines; the last line "(exit 1)" for the exit code where it is not 0. Standard output and error are taken together.
namespace kadr::docs {

struct Example {
  std::string command;
  std::vector<std::string> expected;
  std::size_t command_line = 0;  ///< 1-based line of the command in the document
  std::size_t first_output = 0;  ///< 0-based index of the first expected line
};

/// Bytes of a file; empty where there is none.
std::string text_of(const std::filesystem::path& file);
std::vector<std::string> split_lines(const std::string& text);
std::vector<Example> parse_examples(const std::vector<std::string>& document);

/// True if the line is the pattern, "[..]" standing for any text.
bool matches_line(const std::string& pattern, const std::string& line);
/// True if the output is as expected; "[...]" matches any lines.
bool matches_output(const std::vector<std::string>& expected, const std::vector<std::string>& output);

/// Runs the command with bash in a folder; the programs of `bin` come first. Output without lines of
/// progress, and
/// "(exit N)".
std::vector<std::string> run_command(const std::string& command, const std::string& folder,
                                     const std::string& bin);

/// The document with the outputs that differ replaced; lines that match their pattern stay.
std::string with_outputs(const std::vector<std::string>& document, const std::vector<Example>& examples,
                         const std::vector<std::vector<std::string>>& outputs);

}  // namespace kadr::docs
