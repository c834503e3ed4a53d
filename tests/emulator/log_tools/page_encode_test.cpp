#include <doctest/doctest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "emulator/log_tools/report/encode.h"
#include "emulator/log_tools/report/page_data.h"

using namespace kadr::log_tools;

namespace {

/// What a browser does: base64, raw deflate. Written apart from the code that packs.
std::string unpacked(const std::string& text, std::size_t size) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((count += 6) >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
  }
  std::string out(size, '\0');
  z_stream z{};
  REQUIRE(inflateInit2(&z, -15) == Z_OK);
  z.next_in = reinterpret_cast<Bytef*>(bytes.data());
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  CHECK(inflate(&z, Z_FINISH) == Z_STREAM_END);
  CHECK(z.total_out == size);
  inflateEnd(&z);
  return out;
}

unsigned byte(const std::string& text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

}  // namespace

TEST_CASE("text packed for a page reads back, whatever its length") {
  for (std::size_t n = 0; n < 40; ++n) {
    const std::string text(n, 'k');
    CHECK(unpacked(packed(text), n) == text);
  }
}

TEST_CASE("whole numbers in planes of bytes read back exactly, over the whole range of 32 bits") {
  const std::vector<std::int32_t> values = {0, -1, 5, 2'147'483'647, -2'147'483'647 - 1, 70'000, 70'001};
  const std::size_t n = values.size();
  const std::string planes = unpacked(packed_counts(values), 4 * n);
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 4; ++k) value += byte(planes, k * n + i) << (8 * k);
    CHECK(static_cast<std::int32_t>(value) == values[i]);
  }
}

TEST_CASE("real numbers read back within half a step of their range; codes exactly; no value stays none") {
  std::vector<float> values;
  for (int i = 0; i < 1000; ++i) values.push_back(static_cast<float>(40 * std::sin(0.01 * i)));
  values.push_back(std::numeric_limits<float>::quiet_NaN());
  const std::size_t n = values.size();
  const Quantised q = quantised(values, false);
  CHECK(q.step == doctest::Approx(80.0 / 65534).epsilon(0.01));
  const std::string planes = unpacked(q.data, 2 * n);
  std::uint16_t at = 0;
  double worst = 0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    at = static_cast<std::uint16_t>(at + byte(planes, i) + (byte(planes, n + i) << 8));
    worst = std::max(worst, std::fabs(q.low + q.step * at - values[i]));
  }
  CHECK(worst <= 0.5001 * q.step);
  at = static_cast<std::uint16_t>(at + byte(planes, n - 1) + (byte(planes, 2 * n - 1) << 8));
  CHECK(at == 65535);

  const Quantised codes = quantised({3, 7, 3}, true);
  CHECK(codes.low == 3);
  CHECK(codes.step == 1);
  CHECK(quantised({2, 2}, true).step == 0);
}

TEST_CASE("halving a page's data loses no peak and keeps the last position") {
  PageData data;
  data.tracks.push_back({{"a", "mm", false}, {1, 9, -4, 2, 3}, {1, 9, -4, 2, 3}});
  data.nodes = {{1, 2, 3, 4, 5}};
  data.path_milli = {0, 10, 20, 20, 30};
  halve(data);
  CHECK(data.every == 2);
  CHECK(data.tracks[0].low == std::vector<float>{1, -4, 3});
  CHECK(data.tracks[0].high == std::vector<float>{9, 2, 3});
  CHECK(data.nodes[0] == std::vector<std::int32_t>{2, 4, 5});
  CHECK(data.path_milli == std::vector<std::int32_t>{10, 20, 30});
}
