#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace kadr::gcode {

/// Names of parameters and labels of O words, numbered in order of appearance. Case and blanks don't count:
/// #<Feed Rate> is #<feedrate>. A label written as a number is its digits: O<100> is O100.
class Names {
 public:
  Names();
  /// The number of a name as written between < and >.
  std::int32_t number(std::string_view written);
  /// The name of a number, small letters without blanks.
  const std::string& operator[](std::int32_t number) const {
    return names_[static_cast<std::size_t>(number)];
  }
  std::int32_t size() const { return static_cast<std::int32_t>(names_.size()); }

 private:
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::int32_t> numbers_;
};

/// Parameters whose names begin with _ are global, others local to one call of a subroutine.
inline bool is_global(std::string_view name) { return !name.empty() && name.front() == '_'; }

}  // namespace kadr::gcode
