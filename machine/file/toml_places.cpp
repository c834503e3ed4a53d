#include "machine/file/toml_places.h"

#include <algorithm>

#include "machine/base/utf8.h"

namespace kadr::machine {

namespace {

constexpr std::size_t kMarkStride = 64;  // code points

/// Index behind the string that begins at `at`: behind its closing quotes, or where it breaks off.
std::size_t behind_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string_view three = quote == '"' ? "\"\"\"" : "'''";
  const bool many_lines = text.substr(at, three.size()) == three;
  const std::string_view closing = many_lines ? three : three.substr(0, 1);
  for (at += closing.size(); at < text.size(); ++at) {
    if (!many_lines && text[at] == '\n') return at;
    if (quote == '"' && text[at] == '\\') {
      ++at;
    } else if (text.substr(at, closing.size()) == closing) {
      at += closing.size();
      // up to two more quotes in front of the closing ones belong to the text: """a"""" is a"
      for (int more = 0; many_lines && more < 2 && at < text.size() && text[at] == quote; ++more) ++at;
      return at;
    }
  }
  return text.size();
}

}  // namespace

TomlPlaces::TomlPlaces(std::string_view text) : text_(text), starts_{0} {
  for (std::size_t at = text.find('\n'); at != std::string_view::npos; at = text.find('\n', at + 1))
    starts_.push_back(at + 1);
}

std::string_view TomlPlaces::line(std::uint32_t number) const {
  if (number == 0 || number > starts_.size()) return {};
  const std::size_t begin = starts_[number - 1];
  const std::size_t end = number < starts_.size() ? starts_[number] - 1 : text_.size();
  std::string_view line = text_.substr(begin, end - begin);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

void TomlPlaces::mark(std::uint32_t number) {
  marked_ = number;
  marks_.clear();
  const std::string_view text = line(number);
  std::size_t at = 0;
  for (std::size_t code_point = 0; code_point == 0 || at < text.size(); ++code_point) {
    if (code_point % kMarkStride == 0) marks_.push_back(at);
    if (at < text.size()) at += decode_utf8(text, at).bytes;
  }
}

std::uint32_t TomlPlaces::byte_column(std::uint32_t number, std::uint32_t code_point_column) {
  if (number != marked_) mark(number);
  const std::string_view text = line(number);
  const std::size_t wanted = code_point_column > 0 ? code_point_column - 1 : 0;
  const std::size_t marked = std::min(wanted / kMarkStride, marks_.size() - 1);
  std::size_t at = marks_[marked];
  for (std::size_t i = marked * kMarkStride; i < wanted && at < text.size(); ++i)
    at += decode_utf8(text, at).bytes;
  return static_cast<std::uint32_t>(at + 1);
}

namespace {

/// Goes through a text once; strings and comments are passed over as a whole.
class DepthScan {
 public:
  explicit DepthScan(std::string_view text) : text_(text) {}

  std::optional<TooDeep> run() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        pass_string();
        continue;
      }
      if (c == '#') at_ = std::min(text_.find('\n', at_), text_.size());
      const bool separates = at_ == text_.size() || kSeparators.find(text_[at_]) != std::string_view::npos;
      if (separates && parts_ > kMostKeyParts) return key();
      if (at_ == text_.size()) break;
      // a header ends with its line, closed or not: the parser finds what it lacks
      if (c == '[' && depth_ == 0 && begins_line()) in_header_ = true;
      if (!in_header_ && (c == '[' || c == '{')) ++depth_;
      if (!in_header_ && (c == ']' || c == '}') && depth_ > 0) --depth_;
      if (depth_ > kMostNestedValues)
        return TooDeep{TooDeep::Kind::value, line_, at_ - line_begin_, 1, depth_};
      if (c == '.') ++parts_;
      if (text_[at_] == '\n') begin_line();
      ++at_;
      if (separates) begin_key();
    }
    if (parts_ > kMostKeyParts) return key();
    return std::nullopt;
  }

 private:
  static constexpr std::string_view kSeparators = "=,[]{}\n";

  void begin_key() {
    parts_ = 1;
    key_begin_ = at_;
  }
  /// @pre a line ends at at_
  void begin_line() {
    ++line_;
    line_begin_ = at_ + 1;
    in_header_ = false;
  }
  /// Nothing but blanks is before at_ on its line.
  bool begins_line() const {
    return text_.substr(line_begin_, at_ - line_begin_).find_first_not_of(" \t\xEF\xBB\xBF") ==
           std::string_view::npos;
  }
  void pass_string() {
    const std::size_t end = behind_string(text_, at_);
    for (; at_ < end; ++at_)
      if (text_[at_] == '\n') begin_line();
  }
  TooDeep key() const {
    const std::size_t line_end = std::min(text_.find('\n', line_begin_), text_.size());
    const std::string_view line = text_.substr(line_begin_, line_end - line_begin_);
    std::size_t begin = key_begin_ > line_begin_ ? key_begin_ - line_begin_ : 0;
    begin = std::min(line.find_first_not_of(" \t", begin), line.size());
    std::size_t end = std::max(begin, std::min(at_ - line_begin_, line.size()));
    while (end > begin && (line[end - 1] == ' ' || line[end - 1] == '\t' || line[end - 1] == '\r')) --end;
    // a key that ends with a text of many lines may have nothing on its last one: a caret then
    return {TooDeep::Kind::key, line_, begin, std::max<std::size_t>(end - begin, 1), parts_};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1;
  std::size_t line_begin_ = 0;
  std::size_t key_begin_ = 0, parts_ = 1, depth_ = 0;
  bool in_header_ = false;
};

}  // namespace

std::optional<TooDeep> find_too_deep(std::string_view text) { return DepthScan(text).run(); }

}  // namespace kadr::machine
