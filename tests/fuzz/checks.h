#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "machine/base/diagnostic.h"

/// What the fuzz targets share. A broken check throws BrokenPromise, which ends the program with a trace.
namespace kadr::fuzz {

/// A span lies within its text: a place on a line that is there, or one behind its end.
void check_span(const Span& span, const SourceSet& sources);
/// Every diagnostic has its position and can be printed in each form: for people, gcc, JSON, SARIF.
void check_diagnostics(const Diagnostics& diagnostics, const SourceSet& sources);

}  // namespace kadr::fuzz

/// The entry point of libFuzzer.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
