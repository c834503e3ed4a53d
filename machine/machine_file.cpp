#include <algorithm>
#include <utility>

#include "machine/file/machine_reader.h"
#include "machine/file/tree.h"
#include "machine/machine_file.h"

namespace kadr::machine {

int MachineModel::find_axis(char letter) const {
  for (std::size_t i = 0; i < axis.size(); ++i)
    if (axis[i].letter == letter) return static_cast<int>(i);
  return -1;
}

tl::expected<MachineFile, Diagnostics> read_machine(SourceText text, SourceSet& sources,
                                                    const std::vector<std::string>& overrides) {
  const std::uint32_t file = sources.add(std::move(text));
  Diagnostics found;
  ParsedTree tree = parse_toml(sources, file, found);
  // the command line sees the axes by name only if the whole file could be read
  if (tree.complete) apply_settings(tree.root, overrides, sources, found);

  MachineFile result;
  result.text = std::string(sources[file].text());
  ReadContext context{found, sources, tree.complete, {}};
  const bool readable = tree.complete || !tree.root.entries.empty();
  if (readable) result.model = read_machine_model(tree.root, context);
  result.origins = std::move(context.origins);
  if (!found.has_errors()) return result;

  // in the order of the places, the file before the settings
  found.sort_by_place();
  return tl::unexpected(std::move(found));
}

}  // namespace kadr::machine
