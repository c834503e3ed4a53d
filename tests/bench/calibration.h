#pragma once
#include <chrono>

/// Speed figures are ratios: how many times longer the work took than a fixed loop of dependent additions and
/// multiplications on the same machine. One unit is a million iterations of x = x * a + b (no contraction).
namespace kadr::bench {

inline double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Seconds of one calibration unit now; the best of five.
inline double calibration_unit_s() {
  double best_s = 1e9;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const double begin_s = seconds_now();
    volatile double seed = 0.999999;
    double x = 1.0;
    const double a = seed;
    for (int i = 0; i < 1'000'000; ++i) x = x * a + 1e-9;
    seed = x;
    const double took_s = seconds_now() - begin_s;
    if (took_s < best_s) best_s = took_s;
  }
  return best_s;
}

}  // namespace kadr::bench
