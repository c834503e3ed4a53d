#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gcode/read/tree.h"

/// A program in its normal form, line for line, with the same meaning:
///
///   N10 G90 G1 X1.5 Y-2 F300 M8 (comment)
///
/// - words in the order in which the controller executes them: N, G by group, axes, I J K R P Q L D H E, F S $
///   T, M by group; after them the settings, which apply from the next line on; comments last, in their order
/// - one blank between words, none inside; capital letters; no needless zeros (a point stays: other controls
///   read X10 and X10. differently)
/// - blanks round the operators of an expression, none elsewhere in it
/// - two blanks of indentation per level of O words, of 40 levels at most; comments of neighbouring lines are aligned
/// - lines end in LF, the last one too
///
/// A line that could not be read stays as it is, without a message behind M2 or M30; and so does everything after the % that ends the program.
namespace kadr::gcode {

/// Puts lines into normal form one after another.
class Formatter {
 public:
  /// @param out  the lines are added here; the last few are held back until finish()
  explicit Formatter(std::string& out) : out_(out) {}

  void add(const Line& line);
  /// A line that is kept as it is.
  void keep(std::string_view text);
  void finish() { flush(); }
  /// True once a % has ended the program: the rest means nothing.
  bool ended() const { return ended_; }
  /// True between the beginning and the end of an O word.
  bool inside() const { return !open_.empty(); }

 private:
  struct Open {
    FlowWord word;
    std::int32_t name;
  };
  struct Formatted {
    std::string code;
    std::string comment;
  };

  void sort_items(const Line& line);
  void append_item(std::string& out, const Line& line, std::uint32_t at);
  void append_o_word(std::string& out, const Line& line, std::uint32_t at);
  void append_control(std::string& out, const Line& line, std::uint32_t at);
  void collect_nodes(const Line& line, std::int32_t first, std::int32_t end);
  void append_sorted(std::string& out, const Line& line, bool o_word);
  void append_lexemes(std::string& out, const Line& line, std::uint32_t at);
  std::size_t indentation(const Line& line);
  void note_percent(const Line& line);
  void flush();

  struct Lexeme {
    Bytes bytes;
    NodeKind kind;
  };

  std::string& out_;
  std::vector<Open> open_;                                    ///< O words whose end has not come
  std::map<std::pair<FlowWord, std::int32_t>, int> open_of_;  ///< how many, by word and label
  std::vector<Formatted> run_;                                ///< neighbouring lines with code and a comment
  std::vector<std::uint32_t> order_;                          ///< items of the line in the order printed
  std::vector<std::int32_t> ranks_;                           ///< [items]
  std::vector<Lexeme> lexemes_;
  bool started_ = false;
  bool ended_ = false;
};

/// A number as written without blanks, plus sign and needless zeros: " + 01.500" is 1.5, "10.0" is 10., ".5"
/// is 0.5. Its value stays exactly the same.
/// @param point  false: a point without decimals is removed too, as in a code: G01.0 is G1
std::string plain_number(std::string_view written, bool point = true);

}  // namespace kadr::gcode
