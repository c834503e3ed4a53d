#include "emulator/studies/time_law/problem_machine.h"

#include <fmt/format.h>

#include <utility>

#include "machine/file/named_file.h"

namespace kadr::studies {

std::optional<machine::MachineFile> open_problem_machine(SourceSet& sources, const InputFolders& folders,
                                                         const machine::Reading<std::string>& name,
                                                         machine::ReadContext& context) {
  const std::string_view shipped = machine::shipped_machine(name.value);
  const InputFile file(name.value, folders);
  const InputPlace place =
      shipped.empty() ? machine::look_for(file, name.span, context.diagnostics) : InputPlace::inside;
  if (place == InputPlace::outside) return {};
  if (place == InputPlace::missing) {
    std::string known;
    for (const auto other : machine::shipped_machine_names())
      known += fmt::format("{}{}", known.empty() ? "" : ", ", other);
    Diagnostic d =
        machine::file_diagnostic(Code::problem_program, name.span,
                                 fmt::format("there is no machine '{}' and no such file", name.value));
    d.help = "machines that ship with kadr: " + known;
    context.diagnostics.add(std::move(d));
    return {};
  }
  auto read = machine::read_machine(shipped.empty() ? SourceText::open(file, kMostSettings_bytes)
                                                    : SourceText(name.value + ".toml", std::string(shipped)),
                                    sources);
  if (read) return std::move(*read);
  context.diagnostics.add(read.error());
  return {};
}

machine::AxisModel* find_problem_axis(machine::MachineModel& machine,
                                      const machine::Reading<std::string>& name,
                                      machine::ReadContext& context) {
  const int index = name.value.size() == 1 ? machine.find_axis(name.value.front()) : -1;
  if (index >= 0) return &machine.axis[static_cast<std::size_t>(index)];
  Diagnostic d = machine::file_diagnostic(
      Code::problem_program, name.span, fmt::format("machine {} has no axis '{}'", machine.name, name.value));
  std::string axes;
  for (const machine::AxisModel& axis : machine.axis) axes += fmt::format(" {}", axis.letter);
  d.notes.push_back("allowed:" + axes);
  context.diagnostics.add(std::move(d));
  return nullptr;
}

}  // namespace kadr::studies
