#pragma once
#include <cstdint>
#include <span>
#include <string_view>

#include "gcode/interpret/state.h"

namespace kadr::gcode {

/// Names of the parameters with the state of the interpreter; Names numbers them in this order.
std::span<const std::string_view> predefined_names();
/// True if the name of that number is part of the state: it can be read, not set.
bool is_predefined(std::int32_t name);
/// Value of a predefined parameter, in the units in force.
/// @param line  number of the line that asks
/// @pre is_predefined(name)
double read_predefined(const State& state, std::int32_t name, std::uint32_t line);

}  // namespace kadr::gcode
