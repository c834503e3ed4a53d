#include "machine/file/code_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "machine/file/machine_keys.h"

namespace kadr::machine {
namespace {

const CodeName kToolChange{'M', 6, {}};

void refuse_code(Diagnostics& diagnostics, const Span& span, std::string label, std::string help = {}) {
  Diagnostic d = file_diagnostic(Code::machine_code, span, std::move(label));
  d.help = std::move(help);
  diagnostics.add(std::move(d));
}

/// The code that a text names, if it does and the code is not known already.
std::optional<CodeName> new_code(std::string_view text, const Span& span, const std::vector<CodeName>& known,
                                 Diagnostics& diagnostics) {
  std::optional<CodeName> code = parse_code_name(text);
  if (!code) {
    refuse_code(diagnostics, span, fmt::format("'{}' is no G or M code", text),
                "name codes as a program does: M31, G12.1");
    return {};
  }
  code->span = span;
  if (std::find(known.begin(), known.end(), *code) == known.end()) return code;
  refuse_code(diagnostics, span, fmt::format("{} is given twice", code_text(*code)),
              "keep one entry for each code");
  return {};
}

/// Refuses keys that contradict each other. @return whether the entry says something
bool makes_sense(const OwnerCode& own, TableReader& keys) {
  Diagnostics& diagnostics = keys.context().diagnostics;
  const bool calls = !own.call.empty();
  if (calls && (keys.has("time_s") || keys.has("output") || keys.has("on") || keys.has("stop"))) {
    refuse_code(diagnostics, keys.place(kOwnerCall.name), "a subroutine runs in place of the code",
                "let the subroutine wait (G4) and switch outputs (M62 to M65)");
    return false;
  }
  if (!own.stop && own.output < 0) {
    refuse_code(diagnostics, keys.place("stop"), "nothing happens on the move without an output",
                "name the output, or leave `stop` out");
    return false;
  }
  if (!own.stop && own.time_s > 0) {
    refuse_code(diagnostics, keys.place("stop"), "a code that takes time stops the motion",
                "leave out `stop` or `time_s`");
    return false;
  }
  if (keys.has("on") && own.output < 0) {
    refuse_code(diagnostics, keys.place("on"), "no output is named", "name it: output = 3");
    return false;
  }
  if (calls || own.time_s > 0 || own.output >= 0 || keys.has("stop") || keys.has("time_s")) return true;
  refuse_code(diagnostics, keys.header(), "this entry says nothing",
              "give time_s, output, stop or call, or put the code into `ignore`");
  return false;
}

std::string read_call(TableReader& keys) {
  const auto call = keys.text(kOwnerCall.name, "");
  const bool name = std::all_of(call.value.begin(), call.value.end(), [](char c) {
    return static_cast<unsigned char>(c) > 0x20 && c != '<' && c != '>' && c != '(' && c != '"' && c != 0x7F;
  });
  if (call.valid && name && (!call.value.empty() || !keys.has(kOwnerCall.name))) return call.value;
  if (call.valid)
    refuse_code(keys.context().diagnostics, call.span, "is no name of a subroutine",
                "write the name without O and < >: call = \"clamp\"");
  return {};
}

}  // namespace

std::vector<CodeName> read_code_names(const std::vector<Reading<std::string>>& texts,
                                      const std::vector<CodeName>& known, Diagnostics& diagnostics) {
  std::vector<CodeName> all = known;
  for (const Reading<std::string>& text : texts)
    if (const auto code = new_code(text.value, text.span, all, diagnostics)) all.push_back(*code);
  all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(known.size()));
  return all;
}

OwnerCodes read_owner_codes(const Node* table, const Span& place, bool tool_change_given,
                            PlannerSettings& planner, ReadContext& context) {
  TableReader reader(table, "codes", place, context);
  OwnerCodes codes;
  codes.ignore = read_code_names(reader.texts(kCodesIgnored.name), {}, context.diagnostics);
  std::vector<CodeName> known = codes.ignore;
  if (table == nullptr) return codes;
  for (const Entry& entry : table->entries) {
    if (context.diagnostics.full()) break;
    if (entry.key == kCodesIgnored.name) continue;
    const Node* node = reader.table(entry.key);
    const auto code = new_code(entry.key, entry.key_span, known, context.diagnostics);
    if (node == nullptr || !code) continue;
    known.push_back(*code);
    TableReader keys(node, fmt::format("codes.{}", entry.key), node->span, context);
    OwnerCode own;
    own.code = *code;
    const std::size_t errors = context.diagnostics.errors();
    read_keys(keys, own, kOwnerKeys);
    own.call = read_call(keys);
    keys.finish();
    if (context.diagnostics.errors() != errors || !makes_sense(own, keys)) continue;
    const bool only_time = own.call.empty() && own.output < 0 && own.stop;
    if (own.code != kToolChange || !only_time) {
      codes.own.push_back(own);
    } else if (tool_change_given) {
      refuse_code(context.diagnostics, keys.place("time_s"),
                  "planner.tool_change_s gives the time of M6, too", "keep one of the two");
    } else {
      planner.tool_change_s = own.time_s;
    }
  }
  reader.finish();
  return codes;
}

}  // namespace kadr::machine
