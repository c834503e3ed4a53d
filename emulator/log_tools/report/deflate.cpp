#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "emulator/log_tools/report/encode.h"
#include "machine/base/require.h"

namespace kadr::log_tools {
namespace {

constexpr int kLevel = 6;
constexpr int kRawWindow = -15;  ///< deflate without zlib's own header
constexpr std::uint16_t kNoValue = 65535;
constexpr double kSteps = 65534;

/// zlib's state of a quarter of a megabyte, kept from one array of a page to the next.
class Deflater {
 public:
  Deflater() {
    const int begin = deflateInit2(&z_, kLevel, Z_DEFLATED, kRawWindow, 9, Z_DEFAULT_STRATEGY);
    if (begin == Z_MEM_ERROR) throw std::bad_alloc();
    require(begin == Z_OK, "zlib starts");
  }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;
  ~Deflater() { deflateEnd(&z_); }

  std::string deflated(std::string_view bytes) {
    require(deflateReset(&z_) == Z_OK, "zlib starts again");
    std::string out(deflateBound(&z_, static_cast<uLong>(bytes.size())), '\0');
    z_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    z_.avail_in = static_cast<uInt>(bytes.size());
    z_.next_out = reinterpret_cast<Bytef*>(out.data());
    z_.avail_out = static_cast<uInt>(out.size());
    const int end = deflate(&z_, Z_FINISH);
    require(end == Z_STREAM_END && z_.total_out <= out.size(), "zlib packs into the space it asked for");
    return out.substr(0, z_.total_out);
  }

 private:
  z_stream z_{};
};

std::string deflated(std::string_view bytes) {
  thread_local Deflater deflater;
  return deflater.deflated(bytes);
}

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

}  // namespace

std::string packed(std::string_view bytes) { return base64(deflated(bytes)); }

Quantised quantised(const std::vector<float>& values, bool whole) {
  Quantised out;
  double high = 0;
  bool first = true;
  for (const float v : values) {
    if (!std::isfinite(v)) continue;
    out.low = first ? v : std::min(out.low, double{v});
    high = first ? v : std::max(high, double{v});
    first = false;
  }
  const double range = high - out.low;
  out.step = whole && range <= kSteps ? (range > 0 ? 1 : 0) : range / kSteps;
  out.data = packed_reals(values, out.low, out.step);
  return out;
}

std::string packed_reals(const std::vector<float>& values, double low, double step) {
  const std::size_t n = values.size();
  std::string planes(2 * n, '\0');
  std::uint16_t before = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint16_t q =
        !std::isfinite(values[i]) ? kNoValue
        : step > 0 ? static_cast<std::uint16_t>(std::clamp((values[i] - low) / step + 0.5, 0.0, kSteps))
                   : std::uint16_t{0};
    const auto difference = static_cast<std::uint16_t>(q - before);
    before = q;
    planes[i] = static_cast<char>(difference & 255);
    planes[n + i] = static_cast<char>(difference >> 8);
  }
  return packed(planes);
}

std::string packed_counts(const std::vector<std::int32_t>& values) {
  const std::size_t n = values.size();
  std::string planes(4 * n, '\0');
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto value = static_cast<std::uint32_t>(values[i]);
    const std::uint32_t difference = value - before;
    before = value;
    for (std::size_t k = 0; k < 4; ++k) planes[k * n + i] = static_cast<char>(difference >> (8 * k) & 255);
  }
  return packed(planes);
}

}  // namespace kadr::log_tools
