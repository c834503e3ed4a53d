#include "tests/docs/console_blocks.h"

#include <sys/wait.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace kadr::docs {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    lines.push_back(text.substr(at, end == std::string::npos ? end : end - at));
    if (end == std::string::npos) break;
    at = end + 1;
  }
  return lines;
}

std::vector<Example> parse_examples(const std::vector<std::string>& document) {
  std::vector<Example> examples;
  bool inside = false;
  for (std::size_t i = 0; i < document.size(); ++i) {
    const std::string& line = document[i];
    if (line.starts_with("```")) {
      inside = !inside && line == "```console";
      continue;
    }
    if (!inside) continue;
    if (line.starts_with("$ ")) {
      examples.push_back({line.substr(2), {}, i + 1, i + 1});
    } else if (examples.empty()) {
      throw std::runtime_error("output before the first command, line " + std::to_string(i + 1));
    } else if (line.starts_with("> ") && examples.back().expected.empty()) {
      examples.back().command += "\n" + line.substr(2);
      examples.back().first_output = i + 1;
    } else {
      examples.back().expected.push_back(line);
    }
  }
  if (inside) throw std::runtime_error("a console block is not closed");
  return examples;
}

bool matches_line(const std::string& pattern, const std::string& line) {
  const std::size_t hole = pattern.find("[..]");
  if (hole == std::string::npos) return pattern == line;
  if (line.compare(0, hole, pattern, 0, hole) != 0) return false;
  const std::string rest = pattern.substr(hole + 4);
  for (std::size_t at = hole; at <= line.size(); ++at)
    if (matches_line(rest, line.substr(at))) return true;
  return false;
}

namespace {

bool matches_from(const std::vector<std::string>& expected, std::size_t e,
                  const std::vector<std::string>& output, std::size_t o) {
  if (e == expected.size()) return o == output.size();
  if (expected[e] == "[...]") {
    for (std::size_t skip = o; skip <= output.size(); ++skip)
      if (matches_from(expected, e + 1, output, skip)) return true;
    return false;
  }
  return o < output.size() && matches_line(expected[e], output[o]) &&
         matches_from(expected, e + 1, output, o + 1);
}

}  // namespace

bool matches_output(const std::vector<std::string>& expected, const std::vector<std::string>& output) {
  return matches_from(expected, 0, output, 0);
}

std::vector<std::string> run_command(const std::string& command, const std::string& folder,
                                     const std::string& bin) {
  std::string quoted;
  for (const char c : command) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  const std::string line = "cd '" + folder + "' && PATH='" + bin +
                           "':\"$PATH\" LC_ALL=C NO_COLOR=1 bash -c '" + quoted + "' 2>&1 </dev/null";
  std::FILE* pipe = popen(line.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("bash can't be started");
  std::string text;
  char buffer[4096];
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, n);
  const int status = pclose(pipe);
  std::vector<std::string> lines = split_lines(text);
  // a slow machine prints its progress, a fast one nothing
  std::erase_if(lines, [](const std::string& l) {
    return l.starts_with("kadr: run ") && l.find(" % line ") != l.npos;
  });
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (code != 0) lines.push_back("(exit " + std::to_string(code) + ")");
  return lines;
}

std::string with_outputs(const std::vector<std::string>& document, const std::vector<Example>& examples,
                         const std::vector<std::vector<std::string>>& outputs) {
  std::string text;
  std::size_t next = 0;
  const auto copy_to = [&](std::size_t end) {
    for (; next < end; ++next) text += document[next] + "\n";
  };
  for (std::size_t i = 0; i < examples.size(); ++i) {
    const Example& example = examples[i];
    copy_to(example.first_output);
    const bool same = matches_output(example.expected, outputs[i]);
    const std::vector<std::string>& lines = same ? example.expected : outputs[i];
    for (std::size_t k = 0; k < lines.size(); ++k) {
      // a line with a wildcard that still holds stays, if lines can be matched one to one
      const bool keep =
          !same && example.expected.size() == lines.size() && matches_line(example.expected[k], lines[k]);
      text += (keep ? example.expected[k] : lines[k]) + "\n";
    }
    next += example.expected.size();
  }
  copy_to(document.size());
  return text;
}

}  // namespace kadr::docs
