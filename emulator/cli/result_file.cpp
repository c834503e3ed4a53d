#include "emulator/cli/result_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "emulator/cli/console.h"

namespace kadr::cli {
namespace {

[[noreturn]] void throw_fault(const OutputFault& fault, OutputRules rules) {
  const bool force_helps = !rules.overwrite && fault.reason == std::strerror(EEXIST);
  throw WorldError(
      fmt::format("{}: {}{}", fault.path, fault.reason, force_helps ? "; --force overwrites it" : ""));
}

OutputFile open_output(const std::string& path, OutputRules rules) {
  auto file = OutputFile::open(path, rules);
  if (!file) throw_fault(file.error(), rules);
  return std::move(*file);
}

}  // namespace

ResultFile::ResultFile(const std::string& path, OutputRules rules) : file_(open_output(path, rules)) {}

void ResultFile::write(std::string_view text) {
  if (auto done = file_.write(text); !done) throw_fault(done.error(), {});
}

void ResultFile::close() {
  if (auto done = file_.finish(); !done) throw_fault(done.error(), {});
}

std::string output_text(const std::string& path) { return path == "-" ? "standard output" : path; }

void write_file(const std::string& path, std::string_view text, OutputRules rules) {
  OutputFile file = open_output(path, rules);
  if (auto done = file.write(text); !done) throw_fault(done.error(), rules);
  if (auto done = file.finish(); !done) throw_fault(done.error(), rules);
}

}  // namespace kadr::cli
