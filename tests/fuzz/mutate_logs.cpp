#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>

#include "log_mutations.h"
#include "log_readers.h"

/// Changes tiny true logs and runs every reader over each: mutate_logs COUNT [SEED]; the last line is
/// "N mutations, N findings". A finding is kept as FOLDER/log-SEED with a third argument FOLDER.
///   mutate_logs --bases FOLDER   writes the true logs
/// Numbers whose hash does not fit have to be refused by every reader; a reader that says yes to them is a finding
/// unless its output is that of the true log.
namespace {

using namespace kadr;

struct Base {
  fuzz::Bytes log;
  fuzz::LogAnswers answers;
};

void keep(const std::string& path, const fuzz::Bytes& log) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(log.data()), static_cast<std::streamsize>(log.size()));
}

int write_bases(const std::string& folder) {
  std::size_t number = 0;
  for (const fuzz::Bytes& log : fuzz::true_logs())
    keep(folder + "/true" + std::to_string(number++) + ".lcm", log);
  return 0;
}

struct Tally {
  std::uint64_t sound = 0, findings = 0;
  double slowest_s = 0;
};

/// @return what is wrong; empty: nothing
std::string finding(const fuzz::Mutation& mutation, const Base& base, const fuzz::MemoryFile& file,
                    const fuzz::MemoryFile& other, Tally& tally) {
  try {
    const fuzz::LogAnswers answers = fuzz::read_log(file.path(), other.path());
    tally.sound += answers.sound ? 1 : 0;
    if (answers.sound && !mutation.sealed && answers.text != base.answers.text)
      return "a reader says yes to numbers that were not written";
    return {};
  } catch (const std::exception& e) {
    return e.what();
  }
}

int mutate(std::uint64_t count, std::uint64_t seed, const std::string& folder) {
  fuzz::MemoryFile file, other;
  std::vector<Base> bases;
  for (fuzz::Bytes& log : fuzz::true_logs()) {
    if (bases.empty()) other.write(log.data(), log.size());
    file.write(log.data(), log.size());
    Base base{log, fuzz::read_log(file.path(), other.path())};
    if (!base.answers.sound) {
      std::printf("true log %zu is not sound\n", bases.size());
      return 1;
    }
    bases.push_back(std::move(base));
  }
  Tally tally;
  for (std::uint64_t i = 0; i < count; ++i) {
    fuzz::Chance chance(seed + i);
    const Base& base = bases[chance.below(bases.size())];
    const fuzz::Mutation mutation = fuzz::mutated(base.log, chance);
    file.write(mutation.log.data(), mutation.log.size());
    const auto begin = std::chrono::steady_clock::now();
    const std::string what = finding(mutation, base, file, other, tally);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    tally.slowest_s = std::max(tally.slowest_s, took.count());
    if (what.empty()) continue;
    ++tally.findings;
    std::printf("seed %llu: %s\n", static_cast<unsigned long long>(seed + i), what.c_str());
    if (!folder.empty()) keep(folder + "/log-" + std::to_string(seed + i), mutation.log);
  }
  std::printf("%llu of them read to the end as sound, slowest %.3f s\n%llu mutations, %llu findings\n",
              static_cast<unsigned long long>(tally.sound), tally.slowest_s,
              static_cast<unsigned long long>(count), static_cast<unsigned long long>(tally.findings));
  return tally.findings == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  const std::string first = count > 1 ? arguments[1] : "";
  if (first == "--bases" && count == 3) return write_bases(arguments[2]);
  const std::uint64_t number = std::strtoull(first.c_str(), nullptr, 10);
  if (number == 0) {
    std::fputs("usage: mutate_logs COUNT [SEED [FOLDER]]\n", stderr);
    return 2;
  }
  return mutate(number, count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1,
                count > 3 ? arguments[3] : "");
}
