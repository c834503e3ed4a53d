#include "tests/storm/storm_case.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

#include "machine/base/hash.h"
#include "tests/storm/random_machine.h"
#include "tests/storm/random_program.h"
#include "tests/storm/random_scenario.h"

namespace kadr::storm {
namespace {

namespace fs = std::filesystem;

/// "G5.1" of "G05.1": letter, number without leading zeros.
std::string code_at(const std::string& line, std::size_t& at) {
  std::string code(1, static_cast<char>(std::toupper(static_cast<unsigned char>(line[at++]))));
  while (at < line.size() && line[at] == '0' && at + 1 < line.size() &&
         std::isdigit(static_cast<unsigned char>(line[at + 1])))
    ++at;
  const std::size_t digits = at;
  while (at < line.size() && (std::isdigit(static_cast<unsigned char>(line[at])) || line[at] == '.'))
    code += line[at++];
  return at == digits ? std::string() : code;
}

void add_program(const std::string& text, std::set<std::string>& features) {
  static const char* const kFlow[] = {"if",     "elseif", "while", "do",     "repeat",
                                      "return", "break",  "call",  "endsub", "continue"};
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && (line[0] == 'o' || line[0] == 'O')) {
      std::istringstream words(line);
      std::string word;
      words >> word >> word;
      for (const char* flow : kFlow)
        if (word == flow) features.insert(std::string("flow ") + flow);
    }
    for (std::size_t at = 0; at < line.size();) {
      if (line[at] == '(' || line[at] == ';') break;
      const bool code = (line[at] == 'G' || line[at] == 'M') && (at == 0 || line[at - 1] == ' ');
      if (!code) {
        ++at;
        continue;
      }
      if (const std::string name = code_at(line, at); !name.empty()) features.insert("code " + name);
    }
    for (const char* word : {"(MSG", "(DEBUG", "(PRINT", "(TECH", "@", "^"})
      if (line.find(word) != std::string::npos) features.insert(std::string("word ") + word);
    if (line.find('[') != std::string::npos) features.insert("word [expression]");
  }
}

/// `key = "word"` and `key = true` below [table]: "table.key word".
void add_settings(const std::string& text, std::set<std::string>& features) {
  std::istringstream lines(text);
  std::string table;
  int axes = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line[0] == '[') {
      table = line.substr(line.find_first_not_of('['));
      table.erase(table.find_first_of(']'));
      if (table == "axis") ++axes;
      continue;
    }
    const auto equal = line.find(" = ");
    if (equal == std::string::npos) continue;
    const std::string key = line.substr(0, equal);
    std::string value = line.substr(equal + 3);
    const bool word = value[0] == '"' || value == "true" || value == "false";
    if (!word || key == "name" || key == "on") continue;
    value.erase(std::remove(value.begin(), value.end(), '"'), value.end());
    features.insert((table.empty() ? "" : table + ".") + key + " " + value);
  }
  features.insert("axes " + std::to_string(axes));
}

void add_timeline(const std::string& text, std::set<std::string>& features) {
  std::istringstream lines(text);
  bool step = false;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line[0] == '[') step = line == "[[step]]";
    const auto equal = line.find(" = ");
    if (equal == std::string::npos) continue;
    const std::string key = line.substr(0, equal);
    if (step && key != "value" && key != "for_s" && key != "pass") features.insert("step " + key);
    if (key == "from_line" || key == "to_line") features.insert(key);
    if (key == "dialect") features.insert("dialect " + line.substr(equal + 4, line.size() - equal - 5));
  }
}

}  // namespace

std::size_t StormCase::lines() const {
  std::size_t count = 0;
  for (const auto& [name, text] : files)
    if (name != "README.md") count += static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  return count;
}

std::string read_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("can't write " + path);
}

void write_case(const StormCase& storm_case, const std::string& folder) {
  fs::create_directories(folder);
  for (const auto& [name, text] : storm_case.files) write_file(folder + "/" + name, text);
}

StormCase read_case(const std::string& folder) {
  StormCase storm_case;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file()) {
      const std::string name = entry.path().filename().string();
      storm_case.files[name] = read_file(entry.path().string());
    }
  if (!storm_case.has(kScenarioFile)) throw std::runtime_error(folder + " has no scenario.toml");
  return storm_case;
}

std::vector<std::string> features_of(const StormCase& storm_case) {
  std::set<std::string> features;
  for (const auto& [name, text] : storm_case.files)
    if (name.ends_with(".ngc")) add_program(text, features);
  add_settings(storm_case.text(kMachineFile), features);
  add_timeline(storm_case.text(kScenarioFile), features);
  if (storm_case.has(kFaultFile)) {
    std::istringstream words(storm_case.text(kFaultFile));
    std::string fault, kind;
    words >> fault >> kind;
    features.insert("fault " + (fault == "call" ? fault + " " + kind : fault));
  }
  return {features.begin(), features.end()};
}

StormCase make_case(std::uint64_t seed, bool with_fault) {
  Draw draw(seed);
  const RandomMachine machine = random_machine(draw);
  StormCase storm_case;
  storm_case.files[kMachineFile] = machine.text;
  RandomProgram program = random_program(draw, machine);
  storm_case.files.merge(program.files);
  add_scenario(draw, machine, program, storm_case);
  if (with_fault) storm_case.files[kFaultFile] = random_fault(draw);
  // drawn last: the other cases are as before there was a choice
  if (draw.chance(0.08)) enter_within(draw, storm_case);
  return storm_case;
}

std::uint64_t hash_of_cases(std::uint64_t last) {
  Hash64 hash;
  for (std::uint64_t seed = 1; seed <= last; ++seed)
    for (const auto& [name, text] : make_case(seed, seed % 2 == 0).files) {
      hash.integer(static_cast<std::int64_t>(text.size()));
      hash.bytes(text.data(), text.size());
    }
  return hash.digest();
}

}  // namespace kadr::storm
