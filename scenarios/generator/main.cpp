#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>

#include "machine/base/parse_number.h"
#include "scenarios/generator/wind.h"

/// kadr-wind KIND [--parameter value ...] [-o FILE]: writes a winding program to FILE or standard output.
namespace {

using namespace kadr::scenarios;

void print_usage() {
  fmt::print("usage: kadr-wind KIND [--parameter value ...] [-o FILE]\n");
  for (const auto kind : wind_kinds()) {
    fmt::print("\n{}\n", kind);
    for (const WindParameter& p : wind_parameters(kind)) {
      std::string flag(p.key);
      for (char& c : flag)
        if (c == '_') c = '-';
      fmt::print("  --{:<11} {} ({}; {} to {})\n", flag, p.meaning, kadr::number_text(p.preset),
                 kadr::number_text(p.least), kadr::number_text(p.most));
    }
  }
}

int complain(const std::string& what) {
  fmt::print(stderr, "kadr-wind: {}\n", what);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || std::string_view(argv[1]) == "--help" || std::string_view(argv[1]) == "-h") {
    print_usage();
    return argc < 2 ? 2 : 0;
  }
  const std::string kind = argv[1];
  WindSettings settings;
  std::string file;
  for (int i = 2; i < argc; i += 2) {
    const std::string_view flag = argv[i];
    if (i + 1 >= argc) return complain(fmt::format("{} needs a value", flag));
    if (flag == "-o") {
      file = argv[i + 1];
      continue;
    }
    const auto value = kadr::parse_number(argv[i + 1]);
    if (flag.substr(0, 2) != "--" || !value)
      return complain(fmt::format("not understood: {} {}", flag, argv[i + 1]));
    std::string key(flag.substr(2));
    for (char& c : key)
      if (c == '-') c = '_';
    settings.emplace_back(std::move(key), *value);
  }
  const auto winding = wind(kind, settings);
  if (!winding) return complain(winding.error());
  const std::string text = render_winding(*winding, wind_command(kind, settings));
  std::FILE* out = file.empty() ? stdout : std::fopen(file.c_str(), "wb");
  if (out == nullptr) return complain(fmt::format("can't write {}", file));
  const bool written = std::fwrite(text.data(), 1, text.size(), out) == text.size() && std::fflush(out) == 0;
  if (out != stdout && std::fclose(out) != 0) return complain(fmt::format("can't write {}", file));
  return written ? 0 : complain("the program could not be written in full");
}
