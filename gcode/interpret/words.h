#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gcode/dialect/codes.h"
#include "gcode/dialect/dialect_codes.h"
#include "gcode/flow/evaluate.h"
#include "gcode/interpret/owner_codes.h"
#include "gcode/interpret/state.h"
#include "gcode/read/report.h"
#include "gcode/read/tree.h"

namespace kadr::gcode {

/// Letters A to Z, and the signs of polar words, of a spindle's number, and of ,R and ,C.
inline constexpr std::string_view kWordLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ@^$,&";
constexpr std::size_t letter_index(char letter) {
  if (letter >= 'A' && letter <= 'Z') return static_cast<std::size_t>(letter - 'A');
  return letter == '@' ? 26 : letter == '^' ? 27 : letter == '$' ? 28 : letter == kCornerRadius ? 29 : 30;
}
constexpr std::uint32_t letter_bit(char letter) { return 1U << letter_index(letter); }
constexpr std::uint32_t letter_bits(std::string_view letters) {
  std::uint32_t bits = 0;
  for (const char c : letters) bits |= letter_bit(c);
  return bits;
}

inline constexpr std::uint32_t kAxisBits = letter_bits(kAxisLetters);
inline constexpr int kNoCode = -1;

/// The words of a line by meaning: letters with values, codes by group, settings,
/// comments.
class Words {
 public:
  /// @param owner  codes of the machine's owner; must outlive the words
  explicit Words(Dialect dialect, const OwnerTable& owner) : dialect_(dialect), owner_(&owner) {}

  /// Evaluates every word with the parameters as they stand and sorts it in.
  /// @param report  null: only sort in what can be read, as after a syntax error
  /// @return false if an error was reported, or found in a value that depends on an earlier error
  bool read(const Line& line, const State& state, Report* report);

  bool has(char letter) const { return (present & letter_bit(letter)) != 0; }
  double value(char letter) const { return values_[index(letter)]; }
  void set(char letter, double value) { values_[index(letter)] = value; }
  /// The item of `other` gives this letter too; its value follows by set().
  void stand_in(char letter, char other) {
    present |= letter_bit(letter);
    if ((doubtful & letter_bit(other)) != 0) doubtful |= letter_bit(letter);
    items_[index(letter)] = items_[index(other)];
    values_[index(letter)] = 0;
  }
  void remove(char letter) { present &= ~letter_bit(letter); }
  /// A word as if item `at` of the line gave it.
  void put(char letter, std::size_t at, double value) {
    present |= letter_bit(letter);
    items_[index(letter)] = static_cast<std::uint32_t>(at);
    values_[index(letter)] = value;
  }
  void set(GGroup group, int code) { g_[static_cast<std::size_t>(group)] = static_cast<std::int16_t>(code); }
  const Item& item(const Line& line, char letter) const { return line.items[items_[index(letter)]]; }
  Span span(const Line& line, char letter) const { return line.span(item(line, letter).bytes); }

  /// Of each group, kNoCode where the line has none.
  const auto& g_codes() const { return g_; }
  const auto& m_codes() const { return m_; }
  int g(GGroup group) const { return g_[static_cast<std::size_t>(group)]; }
  int m(MGroup group) const { return m_[static_cast<std::size_t>(group)]; }
  Span span(const Line& line, GGroup group) const {
    return line.span(line.items[g_items_[static_cast<std::size_t>(group)]].bytes);
  }
  Span span(const Line& line, MGroup group) const {
    return line.span(line.items[m_items_[static_cast<std::size_t>(group)]].bytes);
  }
  /// True for axis words, at most with a motion code, and nothing else that has a meaning.
  bool only_moves() const {
    return (present & ~kAxisBits) == 0 && !other_codes_ && !percent && comment < 0 && settings.empty();
  }
  /// A code of the machine's owner on the line.
  struct OwnerUse {
    const OwnerTable::Entry* entry = nullptr;
    std::uint32_t item = 0;
  };
  const std::vector<OwnerUse>& owner_codes() const { return owner_uses_; }
  bool has_axis() const { return (present & kAxisBits) != 0; }
  /// The text of the words that make the line's motion.
  Span motion_span(const Line& line) const { return line.span(motion_); }

  std::uint32_t present = 0;   ///< bit per letter, G M N left out
  std::uint32_t doubtful = 0;  ///< letters whose value may be wrong after an earlier error
  bool any = false;            ///< there is a word or setting on the line
  bool percent = false;
  bool refused_motion = false;  ///< a G code was refused: the next motion is not known
  int comment = -1;             ///< item of the last comment in ( ), the only one that may be a message
  /// A setting of this line: #number = value, or #<name> = value.
  struct Setting {
    int number = 0;
    std::int32_t name = -1;
    double value = 0;
  };
  std::vector<Setting> settings;  ///< in order
  /// A code of the dialect's table that has no effect, or gives P.
  struct OfDialect {
    std::uint32_t item = 0;
    const DialectCode* code = nullptr;
  };
  std::vector<OfDialect> of_dialect;  ///< in order

 private:
  static std::size_t index(char letter) { return letter_index(letter); }
  void clear();
  bool read_word(const Line& line, std::uint32_t at, const State& state, Report* report);
  bool read_g(const Line& line, std::uint32_t at, double value, Report* report);
  bool read_m(const Line& line, std::uint32_t at, double value, Report* report);
  bool read_of_dialect(const Line& line, std::uint32_t at, int& number, bool& done, Report* report);
  bool read_line_number(const Line& line, std::uint32_t at, Report* report);
  bool refuse_word(const Line& line, const Item& item, double value, Report* report) const;
  bool read_setting(const Line& line, const Item& item, const State& state, Report* report);
  bool read_comment(const Line& line, std::uint32_t at, Report* report);
  void widen_motion(Bytes bytes);
  bool take_owner_code(char letter, int number, std::uint32_t at);

  std::array<double, kWordLetters.size()> values_{};
  std::array<std::uint32_t, kWordLetters.size()> items_{};
  std::array<std::int16_t, kGGroups> g_{};
  std::array<std::int16_t, kMGroups> m_{};
  std::array<std::uint32_t, kGGroups> g_items_{};
  std::array<std::uint32_t, kMGroups> m_items_{};
  Bytes motion_;
  Dialect dialect_;
  const OwnerTable* owner_;
  std::vector<OwnerUse> owner_uses_;
  const std::vector<CallLevel>* levels_ = nullptr;  ///< while a line is read
  bool other_codes_ = false;                        ///< an M code, or a G code that is no motion
  Evaluator evaluator_;
};

/// "G92.1" of 921
std::string g_name(int tenths);

/// The command at the beginning of a comment, such as MSG in "(MSG, text)".
struct ActiveComment {
  std::string_view command;  ///< upper or lower case as written; empty: an ordinary comment
  std::string_view text;     ///< after the comma, or after TECH
};
ActiveComment active_comment(std::string_view comment);
bool same_letters(std::string_view text, std::string_view upper_case);

}  // namespace kadr::gcode
