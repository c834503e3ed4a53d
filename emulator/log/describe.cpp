#include "emulator/log/describe.h"

#include <fmt/format.h>

#include <algorithm>

#include "emulator/log/log_messages.h"

namespace kadr::log {
namespace {

constexpr std::size_t kWidth = 120, kCommentColumn = 36;

std::string channel_name(const ChannelTitle& title) {
  return std::string(title.name) + (title.each_axis ? "X" : "");
}

/// "[n_axes][n]"
std::string extent_text(const FieldInfo& field) {
  std::string text;
  for (std::size_t d = 0; d < field.dimensions(); ++d) text += fmt::format("[{}]", field.extent[d]);
  return text;
}

/// A text in a Markdown table: a bar ends a cell.
std::string in_table(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

/// Appends words to a line, going on below its comment where it gets too long.
std::string commented(std::string line, std::size_t column, std::string_view words) {
  std::string out;
  line.resize(std::max(column, line.size() + (line.empty() ? 0 : 2)), ' ');
  line += "//";
  while (!words.empty()) {
    const std::string_view word = words.substr(0, words.find(' '));
    if (line.size() + 1 + word.size() > kWidth) {
      out += line + '\n';
      line = std::string(column, ' ') + "//";
    }
    line += ' ';
    line += word;
    words.remove_prefix(std::min(words.size(), word.size() + 1));
  }
  return out + line + '\n';
}

std::string lcm_struct(const ChannelDescription& channel) {
  std::string head = channel_name(channel.title) + (channel.title.each_axis ? ", one for each axis" : "");
  std::string out = commented("", 0, fmt::format("{}: {}.", head, channel.title.sentence));
  out += fmt::format("struct {} {{\n", channel.title.type);
  for (const FieldInfo& field : channel.fields) {
    const std::string line =
        fmt::format("  {:<7} {}{};", kWires.word(field.wire), field.name, extent_text(field));
    out += field.sentence.empty() ? line + '\n' : commented(line, kCommentColumn, field.sentence);
  }
  return out + "}\n";
}

}  // namespace

std::vector<ChannelDescription> describe_channels() {
  std::vector<ChannelDescription> list;
  for_each_channel(Channels{}, [&]<class R>() {
    static_assert(well_formed<R>());
    const auto& fields = Channel<R>::fields;
    list.push_back({Channel<R>::info, fingerprint<R>(), {fields.begin(), fields.end()}});
  });
  return list;
}

std::string lcm_definition() {
  std::string out =
      "package kadr;\n\n"
      "// The messages of a kadr log; docs/log_format.md explains them. Written by test_logs with "
      "KADR_REGENERATE=1\n"
      "// from the tables of emulator/log/channels/.\n"
      "// `tick` counts base-clock ticks since program start. `_u` is mm or deg (run_t.axis_units; mm for "
      "paths of X Y "
      "Z).\n"
      "// All numbers are big-endian, as LCM writes them.\n";
  for (const ChannelDescription& channel : describe_channels()) out += '\n' + lcm_struct(channel);
  return out;
}

std::string channel_table() {
  std::string out = "| channel | type | fingerprint | when |\n|---|---|---|---|\n";
  for (const ChannelDescription& channel : describe_channels())
    out += fmt::format("| `{}`{} | `{}` | {:016x} | {} |\n", channel_name(channel.title),
                       channel.title.each_axis ? " ..." : "", channel.title.type,
                       static_cast<std::uint64_t>(channel.fingerprint), channel.title.sentence);
  return out;
}

std::string field_tables() {
  std::string out;
  for (const ChannelDescription& channel : describe_channels()) {
    out += fmt::format("### {} ({})\n\n| field | type | unit | meaning |\n|---|---|---|---|\n",
                       channel_name(channel.title), channel.title.type);
    for (const FieldInfo& field : channel.fields)
      out += fmt::format("| `{}{}` | {} | {} | {} |\n", field.name, extent_text(field),
                         kWires.word(field.wire), unit_symbol(field.unit), in_table(field.sentence));
    out += '\n';
  }
  out.pop_back();
  return out;
}

}  // namespace kadr::log
