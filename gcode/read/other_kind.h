#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "machine/base/diagnostic.h"

namespace kadr::gcode {

/// What a text is that is written in G-code's letters, but not for a machine that kadr emulates.
struct OtherKind {
  std::string name;  ///< "a slicer's file for a 3D printer"
  std::string help;
};

/// Looks for what only a slicer, Sinumerik, Heidenhain or a Fanuc macro writes, in the first 2000 lines. To be asked of
/// texts with errors alone: what it looks for is an error for kadr, too.
/// @param macros  the dialect has macro B, so that this is no other kind
std::optional<OtherKind> other_kind(std::string_view text, bool macros = false);

/// "UTF-16" or "UTF-32" if the bytes are a text in it: by its byte order mark, or by the zeros between Latin letters.
std::string_view other_encoding(std::string_view text);
/// The one error of a text in such an encoding.
std::optional<Diagnostic> encoding_problem(std::uint32_t file, std::string_view text);

}  // namespace kadr::gcode
