#pragma once
#include "machine/base/confinement.h"
#include "machine/base/diagnostic.h"

namespace kadr::machine {

/// Looks for a file that a key of a scenario or problem names. One outside its folders is told at the key (K3014), a
/// missing one is not.
InputPlace look_for(const InputFile& file, const Span& key, Diagnostics& diagnostics);

}  // namespace kadr::machine
