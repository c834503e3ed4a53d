#include "machine/file/named_file.h"

#include <fmt/format.h>

#include <utility>

#include "machine/file/tree.h"

namespace kadr::machine {

InputPlace look_for(const InputFile& file, const Span& key, Diagnostics& diagnostics) {
  const InputPlace place = place_of(file);
  if (place != InputPlace::outside) return place;
  Diagnostic d = file_diagnostic(Code::file_outside, key, fmt::format("{} lies outside", file.path));
  d.notes.push_back(fmt::format("allowed: files below {}, where links lead", file.folders->text()));
  d.help = "put the file there, or allow the folder that it is in with --allow DIR";
  diagnostics.add(std::move(d));
  return place;
}

}  // namespace kadr::machine
