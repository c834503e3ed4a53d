#pragma once
#include "gcode/interpret/interpreter.h"
#include "gcode/interpret/state.h"
#include "gcode/interpret/words.h"

/// Tree to Blocks: Interpreter takes a line whose expressions have values (Words), checks that its words may
/// fit together (check*.cpp), changes the modal State, and emits the Blocks that the line means: motion,
/// cycles, splines, probing, tools and offsets, inputs and outputs, a .cpp each.
