#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

/// What a terminal may be shown. Programs, machines, scenarios, logs and names of files are written by strangers: an
/// escape sequence in one of them could retitle, clear or type into the terminal of who looks at it, and a mark of
/// direction (U+202E) makes a name look like another. This rule is the only one; the sink of the command line
/// (emulator/cli/standard_streams.h) holds all texts to it, whoever composed them.
namespace kadr {

/// False for the code points that are shown as U+FFFD: control characters (U+0000..1F, U+7F..9F), line and paragraph
/// separators, marks, embeddings and isolates of direction, and what Unicode lets a terminal show as nothing (soft hyphen,
/// zero-width space, byte-order mark, tags). The joiners U+200C and U+200D and the variation selectors U+FE00..FE0F stay:
/// scripts and emoji need them.
bool may_be_shown(char32_t code_point);

/// Terminal columns of a code point as it is shown: 0 for combining marks, 2 for East Asian wide forms, 1 otherwise.
int display_width(char32_t code_point);

/// A foreign text as one line: tabs expanded to columns of 8 (counted from `column`), line ends, bytes that are not UTF-8
/// and whatever may not be shown replaced by U+FFFD.
/// @param column  display column at which the text begins; moved to where it ends
std::string displayable(std::string_view text, std::size_t& column);
/// The same of a text that begins a line, such as the name of a file.
std::string displayable(std::string_view text);

/// The colours of our messages, as sequences of a terminal.
namespace style {
inline constexpr std::string_view kNote = "\x1b[1;36m", kWarning = "\x1b[1;33m", kError = "\x1b[1;31m",
                                  kPlace = "\x1b[1;34m", kBold = "\x1b[1m", kOff = "\x1b[0m";
inline constexpr std::array kAll = {kNote, kWarning, kError, kPlace, kBold, kOff};
}  // namespace style

/// Number of bytes at the beginning of a text of several lines that are shown as they are.
std::size_t shown_bytes(std::string_view text);

/// May the sequences of style::kAll, and no others, stay in a text?
enum class Styles : bool { replaced, kept };

/// A text of several lines as it is shown: line ends and tabs stay; bytes that are not UTF-8 and whatever may not be
/// shown are replaced by U+FFFD.
std::string shown_text(std::string_view text, Styles styles = Styles::replaced);
/// The same, at the end of another text.
void append_shown(std::string& out, std::string_view text, Styles styles = Styles::replaced);

}  // namespace kadr
