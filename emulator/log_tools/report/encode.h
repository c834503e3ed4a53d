#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Arrays of a report page, packed so that a browser unpacks them without a library: planes of bytes, raw
/// deflate (RFC 1951), base64.
namespace kadr::log_tools {

/// Raw deflate at a fixed level, base64. The bytes depend on the zlib that does it, what they hold does not.
std::string packed(std::string_view bytes);

/// A row of real numbers as 16-bit steps of their range: value = low + step_u * q, differences of q modulo
/// 2^16, all low bytes before all high bytes. 65535 stands for "no value".
struct Quantised {
  double low = 0;
  double step = 0;  ///< 0: all values are `low`
  std::string data;
};
/// @param whole  integers of a range below 65535 keep their exact value
Quantised quantised(const std::vector<float>& values, bool whole);

/// Values in given steps from `low`, packed as the data of Quantised; they are within its range.
std::string packed_reals(const std::vector<float>& values, double low, double step);

/// Whole numbers exactly: differences modulo 2^32 in four planes of bytes, the first one to 0.
std::string packed_counts(const std::vector<std::int32_t>& values);

}  // namespace kadr::log_tools
