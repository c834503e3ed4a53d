#include "tests/storm/shrink.h"

#include <cctype>
#include <chrono>
#include <cstdlib>
#include <string_view>

#include "tests/storm/draw.h"

namespace kadr::storm {
namespace {

using Clock = std::chrono::steady_clock;
using Pieces = std::vector<std::string>;

std::string joined(const Pieces& pieces) {
  std::string text;
  for (const std::string& piece : pieces) text += piece;
  return text;
}

Pieces lines_of(const std::string& text) {
  Pieces lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const std::size_t next = end == std::string::npos ? text.size() : end + 1;
    lines.push_back(text.substr(at, next - at));
    at = next;
  }
  return lines;
}

/// Tables of a file: each begins at its header.
Pieces tables_of(const std::string& text) {
  Pieces tables;
  for (const std::string& line : lines_of(text)) {
    const bool own = line[0] == '[' && !line.starts_with("[axis.plant]");
    if (tables.empty() || own) tables.emplace_back();
    tables.back() += line;
  }
  return tables;
}

/// Words of a line, with the blanks before them; the line's end is a piece of its own.
Pieces words_of(const std::string& line) {
  Pieces words;
  for (std::size_t at = 0; at < line.size();) {
    std::size_t end = line.find_first_not_of(" \n", at);
    if (end == std::string::npos) end = line.size();
    end = line.find_first_of(" \n", end);
    if (end == std::string::npos) end = line.size();
    if (end == at) end = line.size();
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

class Shrinker {
 public:
  Shrinker(const StormCase& storm_case, Invariant invariant, std::uint64_t seed, const CheckOptions& options,
           double minutes, int tries)
      : case_(storm_case),
        invariant_(invariant),
        seed_(seed),
        options_(options),
        end_(Clock::now() +
             std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(60 * minutes))),
        tries_(tries) {}

  StormCase shrink() {
    for (bool smaller = true; smaller && !late();) {
      smaller = false;
      for (const char* name : {kOtherFile, kFaultFile, kToolsFile, "beside.ngc"})
        if (case_.has(name)) smaller = without_file(name) || smaller;
      for (const char* name : {kScenarioFile, kOtherFile, kMachineFile})
        if (case_.has(name)) smaller = fewer(name, tables_of) || smaller;
      for (const std::string& name : names()) smaller = fewer(name, lines_of) || smaller;
      for (const std::string& name : names())
        if (name.ends_with(".ngc")) smaller = fewer_words(name) || smaller;
      for (const std::string& name : names()) smaller = shorter_numbers(name) || smaller;
    }
    return case_;
  }

 private:
  bool late() const { return Clock::now() > end_; }
  std::vector<std::string> names() const {
    std::vector<std::string> list;
    for (const auto& file : case_.files)
      if (file.first != kFaultFile) list.push_back(file.first);
    return list;
  }

  bool still_fails(const StormCase& tried) const {
    for (int i = 0; i < tries_; ++i) {
      const Checked checked = isolated_check(tried, seed_, options_);
      if (checked.finding && checked.finding->invariant == invariant_) return true;
    }
    return false;
  }
  bool take(StormCase tried) {
    if (late() || !still_fails(tried)) return false;
    case_ = std::move(tried);
    return true;
  }

  bool without_file(const std::string& name) {
    StormCase tried = case_;
    tried.files.erase(name);
    if (name == kToolsFile) {
      for (const char* file : {kScenarioFile, kOtherFile}) {
        if (!tried.has(file)) continue;
        std::string& text = tried.files[file];
        const std::string key = "tools = \"tools.tbl\"\n";
        if (const auto at = text.find(key); at != std::string::npos) text.erase(at, key.size());
      }
    }
    return take(std::move(tried));
  }

  /// Leaves out halves, quarters, ... of the pieces of a text.
  bool reduce(const Pieces& whole, const std::function<bool(const Pieces&)>& takes) {
    Pieces pieces = whole;
    bool smaller = false;
    for (std::size_t size = std::max<std::size_t>(1, pieces.size() / 2); !late(); size /= 2) {
      for (std::size_t at = 0; at < pieces.size() && !late();) {
        const std::size_t count = std::min(size, pieces.size() - at);
        Pieces tried = pieces;
        tried.erase(tried.begin() + static_cast<std::ptrdiff_t>(at),
                    tried.begin() + static_cast<std::ptrdiff_t>(at + count));
        if (takes(tried)) {
          pieces = std::move(tried);
          smaller = true;
        } else {
          at += count;
        }
      }
      if (size <= 1) break;
    }
    return smaller;
  }

  bool fewer(const std::string& name, Pieces (*split)(const std::string&)) {
    return reduce(split(case_.files[name]), [&](const Pieces& pieces) {
      StormCase tried = case_;
      tried.files[name] = joined(pieces);
      return take(std::move(tried));
    });
  }

  bool fewer_words(const std::string& name) {
    Pieces lines = lines_of(case_.files[name]);
    bool smaller = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const Pieces words = words_of(lines[i]);
      if (words.size() < 3) continue;
      smaller = reduce(words,
                       [&](const Pieces& fewer_pieces) {
                         Pieces tried_lines = lines;
                         tried_lines[i] = joined(fewer_pieces);
                         if (!tried_lines[i].ends_with('\n')) tried_lines[i] += '\n';
                         StormCase tried = case_;
                         tried.files[name] = joined(tried_lines);
                         if (!take(std::move(tried))) return false;
                         lines = tried_lines;
                         return true;
                       }) ||
                smaller;
    }
    return smaller;
  }

  /// Each number with one digit, else with two.
  bool shorter_numbers(const std::string& name) {
    bool smaller = false;
    const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) || c == '.'; };
    for (std::size_t at = 0; at < case_.files[name].size() && !late(); ++at) {
      const std::string& text = case_.files[name];
      // "G5.1", "M62" and "#101" are names
      const bool begins = digit(text[at]) && (at == 0 || (!digit(text[at - 1]) && text[at - 1] != 'G' &&
                                                          text[at - 1] != 'M' && text[at - 1] != '#'));
      if (!begins) continue;
      std::size_t end = at;
      while (end < text.size() && digit(text[end])) ++end;
      const std::string number = text.substr(at, end - at);
      if (number.size() <= 2) continue;
      for (const int digits : {1, 2}) {
        const std::string shorter = plain(std::strtod(plain_digits(number, digits).c_str(), nullptr), 12);
        if (shorter.size() >= number.size()) continue;
        StormCase tried = case_;
        tried.files[name].replace(at, end - at, shorter);
        if (!take(std::move(tried))) continue;
        smaller = true;
        break;
      }
    }
    return smaller;
  }
  static std::string plain_digits(const std::string& number, int digits) {
    return fmt::format("{:.{}e}", std::strtod(number.c_str(), nullptr), digits - 1);
  }

  StormCase case_;
  const Invariant invariant_;
  const std::uint64_t seed_;
  const CheckOptions& options_;
  const Clock::time_point end_;
  const int tries_;
};

}  // namespace

StormCase shrunk(const StormCase& storm_case, Invariant invariant, std::uint64_t seed,
                 const CheckOptions& options, double minutes, int tries) {
  return Shrinker(storm_case, invariant, seed, options, minutes, tries).shrink();
}

}  // namespace kadr::storm
