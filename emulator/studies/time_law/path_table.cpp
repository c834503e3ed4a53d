#include "emulator/studies/time_law/path_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "emulator/studies/time_law/problem.h"
#include "emulator/text/text.h"
#include "machine/base/parse_number.h"
#include "machine/file/tree.h"

namespace kadr::studies {
namespace {

constexpr std::size_t kMostMistakes = 20;
constexpr double kMostValue = 1e8;  ///< of an axis, as positions of a machine file
constexpr double kMostS_mm = 1e9;

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
    text.remove_suffix(1);
  return text;
}

class TableText {
 public:
  TableText(const SourceSet& sources, std::uint32_t file, const std::vector<std::string>& axes,
            Diagnostics& diagnostics)
      : text_(sources[file].text()), file_(file), axes_(axes), diagnostics_(diagnostics) {}

  std::optional<PathTable> read() {
    const std::size_t errors = diagnostics_.errors();
    if (text_.starts_with("\xEF\xBB\xBF")) next_ = 3;
    if (!next_line() || !read_header()) {
      if (diagnostics_.errors() == errors) tell({file_, 1, 1, 1}, "the file is empty", header_help());
      return {};
    }
    while (diagnostics_.errors() - errors < kMostMistakes && next_line())
      if (!read_row()) break;
    if (diagnostics_.errors() != errors) return {};
    if (table_.s_u.size() < 4) {
      tell({file_, std::max(line_, 1u), 1, 1},
           text::counted(static_cast<std::int64_t>(table_.s_u.size()), "row") + ", at least 4 are needed");
      return {};
    }
    return std::move(table_);
  }

 private:
  void tell(const Span& span, std::string label, std::string help = "") {
    Diagnostic d = machine::file_diagnostic(Code::problem_table, span, std::move(label));
    d.help = std::move(help);
    diagnostics_.add(std::move(d));
  }

  std::string header_help() const {
    return fmt::format("the first line names the columns: s,{}", fmt::join(axes_, ","));
  }

  /// Goes to the next line that is not blank or a comment.
  bool next_line() {
    while (next_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', next_), text_.size());
      row_ = text_.substr(next_, end - next_);
      next_ = end + 1;
      ++line_;
      const std::string_view said = trimmed(row_);
      if (!said.empty() && said.front() != '#') return true;
    }
    return false;
  }

  /// Fields of the line, with their positions.
  void split() {
    fields_.clear();
    for (std::size_t begin = 0;;) {
      const std::size_t end = std::min(row_.find(',', begin), row_.size());
      fields_.push_back(trimmed(row_.substr(begin, end - begin)));
      if (end == row_.size()) return;
      begin = end + 1;
    }
  }

  Span span(std::string_view part) const {
    const auto column = static_cast<std::uint32_t>(part.data() - row_.data() + 1);
    return {file_, line_, column, std::max<std::uint32_t>(1, static_cast<std::uint32_t>(part.size()))};
  }

  bool read_header() {
    split();
    const std::size_t errors = diagnostics_.errors();
    if (fields_[0] != "s") tell(span(fields_[0]), "the first column is s, in mm", header_help());
    std::vector<bool> seen(axes_.size(), false);
    for (std::size_t i = 1; i < fields_.size() && diagnostics_.errors() - errors < kMostMistakes; ++i) {
      const auto found = std::find(axes_.begin(), axes_.end(), fields_[i]);
      const auto axis = static_cast<std::size_t>(found - axes_.begin());
      if (found == axes_.end()) {
        tell(span(fields_[i]), fmt::format("no [[axis]] is named '{}'", fields_[i]), header_help());
      } else if (seen[axis]) {
        tell(span(fields_[i]), fmt::format("axis {} already has a column", fields_[i]));
      } else {
        seen[axis] = true;
        axis_of_.push_back(axis);
      }
    }
    if (diagnostics_.errors() != errors) return false;
    for (std::size_t c = 0; c < axes_.size(); ++c)
      if (!seen[c]) tell(span(trimmed(row_)), fmt::format("axis {} has no column", axes_[c]), header_help());
    return diagnostics_.errors() == errors;
  }

  std::optional<double> number(std::string_view field, std::string_view name, double most) {
    const auto value = parse_number(field);
    if (!value) {
      tell(span(field), fmt::format("{} is '{}', must be a number", name, field),
           field.empty() ? "write a value for every axis" : "");
    } else if (std::fabs(*value) > most) {
      tell(span(field), fmt::format("{} is {}, must be from {} to {}", name, number_text(*value),
                                    number_text(-most), number_text(most)));
    } else {
      return value;
    }
    return {};
  }

  /// @return false if no further row is worth reading
  bool read_row() {
    split();
    if (fields_.size() != axes_.size() + 1) {
      tell(span(trimmed(row_)),
           fmt::format("{} values, the first line names {} columns", fields_.size(), axes_.size() + 1));
      return true;
    }
    if (static_cast<double>(table_.s_u.size()) >= kMostNodes) {
      tell(span(trimmed(row_)), fmt::format("more than {:.0f} rows", kMostNodes));
      return false;
    }
    const auto s = number(fields_[0], "s", kMostS_mm);
    const std::size_t at = table_.values.size();
    table_.values.resize(at + axes_.size());
    for (std::size_t i = 1; i < fields_.size(); ++i)
      table_.values[at + axis_of_[i - 1]] =
          number(fields_[i], axes_[axis_of_[i - 1]], kMostValue).value_or(0.0);
    if (!s) return true;
    if (!table_.s_u.empty() && *s < table_.s_u.back() + kLeastStep_mm)
      tell(span(fields_[0]),
           fmt::format("s is {}, in the row before {}: it must increase by {} or more", number_text(*s),
                       number_text(table_.s_u.back()), number_text(kLeastStep_mm)));
    table_.s_u.push_back(*s);
    return true;
  }

  static constexpr double kLeastStep_mm = 1e-6;

  std::string_view text_, row_;
  std::size_t next_ = 0;
  std::uint32_t file_, line_ = 0;
  const std::vector<std::string>& axes_;
  Diagnostics& diagnostics_;
  std::vector<std::string_view> fields_;
  std::vector<std::size_t> axis_of_;  // [columns after s]
  PathTable table_;
};

}  // namespace

std::optional<PathTable> read_path_table(const SourceSet& sources, std::uint32_t file,
                                         const std::vector<std::string>& axes, Diagnostics& diagnostics) {
  return TableText(sources, file, axes, diagnostics).read();
}

}  // namespace kadr::studies
