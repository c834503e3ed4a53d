#pragma once
#include "machine/file/table_reader.h"

namespace kadr::machine {

/// Maps a tree to a machine and checks that the values fit each other. Every mistake goes to
/// context.diagnostics; the result means something only if there was none.
MachineModel read_machine_model(const Node& root, ReadContext& context);

/// Reads [[axis]] number `index` (0-based); `clock` bounds the step rate.
AxisModel read_axis(const Node& table, std::size_t index, const ClockModel& clock, double& home2_u,
                    ReadContext& context);

// Bounds of the settings, in the unit of the key. The outer ends are far beyond any machine: they guard
// products and squares of the values against overflow, and make step counts exact (1e8 / 1e-7 = 1e15 steps <
// 2^53).
inline constexpr Bounds kFeedBounds{1e-6, 1e9};
inline constexpr Bounds kAccelBounds{1e-6, 1e12};
inline constexpr Bounds kJerkBounds{1e-6, 1e15, true};
inline constexpr Bounds kStepBounds{1e-7, 1e6};
inline constexpr Bounds kStepsPerBounds{1e-6, 1e7};
inline constexpr Bounds kPositionBounds{-1e8, 1e8};
inline constexpr Bounds kRangeBounds{-1e8, 1e8, true};
inline constexpr Bounds kMassBounds{1e-9, 1e9};
inline constexpr Bounds kStiffnessBounds{1e-9, 1e15};
inline constexpr Bounds kDampingBounds{0, 1e12};
inline constexpr Bounds kForceBounds{1e-9, 1e12};
inline constexpr Bounds kPitchBounds{1e-6, 1e6};

}  // namespace kadr::machine
