#include "tests/storm/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace kadr::storm {
namespace {

/// Counts by size, as "name count" with a share of the seeds.
std::string by_size(const Tally& tally, std::uint64_t seeds) {
  std::vector<std::pair<std::string, std::int64_t>> list(tally.begin(), tally.end());
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [name, count] : list)
    text += fmt::format("  {:>9} {:6.2f} %  {}\n", count,
                        100.0 * static_cast<double>(count) / static_cast<double>(seeds), name);
  return text;
}

/// Features of one kind on a line: "planner.method: certified 12, scheduler 40".
std::string by_kind(const Tally& tally) {
  std::string text, kind;
  for (const auto& [name, count] : tally) {
    const auto space = name.find(' ');
    if (name.substr(0, space) != kind) {
      kind = name.substr(0, space);
      text += fmt::format("{}  {}:", text.empty() ? "" : "\n", kind);
    }
    text += fmt::format(" {} {},", name.substr(space + 1), count);
  }
  std::string cleaned;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] != ',' || (i + 1 < text.size() && text[i + 1] != '\n')) cleaned += text[i];
  return cleaned + "\n";
}

}  // namespace

void Report::add(const SeedResult& result) {
  ++seeds_;
  const Checked& checked = result.checked;
  ++ends_[checked.end.empty() ? "before it was planned" : checked.end];
  for (const auto& [what, count] : checked.met) met_[what] += count;
  for (const std::string& feature : result.features) ++features_[feature];
  if (checked.finding) ++findings_;
  cpu_s_ += checked.cpu_s;
  if (checked.cpu_s > slowest_s_) {
    slowest_s_ = checked.cpu_s;
    slowest_seed_ = result.seed;
  }
}

std::string Report::text() const {
  if (seeds_ == 0) return "";
  return fmt::format(
      "how they ended\n{}checks that had something to look at\n{}features\n{}"
      "processor time: {:.4f} s a seed, at most {:.2f} s (seed {})\n",
      by_size(ends_, seeds_), by_size(met_, seeds_), by_kind(features_), cpu_s_ / static_cast<double>(seeds_),
      slowest_s_, slowest_seed_);
}

}  // namespace kadr::storm
