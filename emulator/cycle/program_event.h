#pragma once
#include "emulator/emulator.h"
#include "emulator/log/records.h"

namespace kadr::cycle {

/// Events at which the machine stops: it waits for spindle, coolant, input or operator, or an output
/// changes at once.
bool needs_rest(const gcode::Block& block);
/// The events of the log besides motion. Modal settings are part of each motion block: no events.
bool is_event(const gcode::Block& block);
/// An output that changes as the next motion begins: M62 M63 M67.
bool waits_for_motion(const gcode::Block& block);

/// Kind, value and text of the log's record; the caller adds tick, block and position.
/// @pre is_event(event.block), or a probing move
log::EventRecord event_record(const ProgramEvent& event);

}  // namespace kadr::cycle
