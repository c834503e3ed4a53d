#pragma once
#include "machine/file/table_reader.h"

namespace kadr::machine {

/// Maps a tree to a machine and checks that the values fit each other. Every mistake goes to
/// context.diagnostics; the result means something only if there was none.
MachineModel read_machine_model(const Node& root, ReadContext& context);

/// Reads [[axis]] number `index` (0-based); `clock` bounds the step rate.
AxisModel read_axis(const Node& table, std::size_t index, const ClockModel& clock, double& home2_u,
                    ReadContext& context);

}  // namespace kadr::machine
