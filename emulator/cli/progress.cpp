#include "emulator/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "emulator/cli/standard_streams.h"

namespace kadr::cli {
namespace {

constexpr double kSilence_s = 0.3;
constexpr double kRedraw_s = 0.1;
constexpr double kPlainEvery_s = 10;
constexpr int kBarCells = 12;

bool terminal() {
  const char* term = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) && !std::getenv("CI") && term && std::string_view(term) != "dumb";
}

std::string cells(double done) {
  const int filled = std::clamp(static_cast<int>(done * kBarCells), 0, kBarCells);
  std::string bar;
  for (int i = 0; i < kBarCells; ++i) bar += i < filled ? "█" : "░";
  return bar;
}

int percent(double done) { return static_cast<int>(std::clamp(done, 0.0, 1.0) * 100); }

}  // namespace

std::string progress_bar(double done, std::uint32_t line, std::uint32_t lines, double sim_s, double wall_s) {
  const double rate = wall_s > 0 ? sim_s / wall_s : 0;
  std::string text = fmt::format("run  {}  {:2} %  line {}/{}  {:.1f} s of machine  {:.{}f}x real time",
                                 cells(done), percent(done), line, lines, sim_s, rate, rate < 10 ? 1 : 0);
  if (done > 0.01) {
    const double left_s = std::min(wall_s * (1 - std::min(done, 1.0)) / done, 359'999.0);
    const int seconds = static_cast<int>(left_s + 0.5);
    text += seconds < 3600
                ? fmt::format("  ETA {}:{:02}", seconds / 60, seconds % 60)
                : fmt::format("  ETA {}:{:02}:{:02}", seconds / 3600, seconds % 3600 / 60, seconds % 60);
  }
  return text;
}

std::string progress_line(double done, std::uint32_t line, std::uint32_t lines, double sim_s) {
  return fmt::format("kadr: run {} % line {}/{} sim {:.1f} s", percent(done), line, lines, sim_s);
}

std::string stage_bar(std::string_view stage, double done) {
  const std::string text = fmt::format("tube  {}", stage);
  return done < 0 ? text : fmt::format("{}  {}  {:2} %", text, cells(done), percent(done));
}

ProgressLine::ProgressLine(const OutputOptions& options, Elsewhere elsewhere) {
  const bool automatic = options.progress == ProgressMode::automatic;
  if (options.quiet || options.format == DiagnosticFormat::sarif || options.progress == ProgressMode::never)
    kind_ = Kind::none;
  else if (automatic && terminal())
    kind_ = Kind::bar;
  else
    kind_ = automatic && elsewhere == Elsewhere::nothing ? Kind::none : Kind::plain;
  next_s_ = kind_ == Kind::bar ? kSilence_s : kPlainEvery_s;
}

double ProgressLine::wall_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

void ProgressLine::show(const std::string& text) {
  const double now_s = wall_s();
  if (kind_ == Kind::bar) {
    tell_over(text);
    drawn_ = true;
    next_s_ = now_s + kRedraw_s;
  } else {
    tell(text + '\n');
    next_s_ = now_s + kPlainEvery_s;
  }
}

void ProgressLine::erase() {
  if (drawn_) tell_over({});
  drawn_ = false;
}

void Progress::update(double done, std::uint32_t line, double sim_s) {
  line_.update([&] { return progress_bar(done, line, lines_, sim_s, wall_s()); },
               [&] { return progress_line(done, line, lines_, sim_s); });
}

}  // namespace kadr::cli
