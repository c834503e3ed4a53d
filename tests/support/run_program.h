#pragma once
#include <doctest/doctest.h>

#include <string>

#include "emulator/emulator.h"
#include "tests/support/recording_log.h"

namespace kadr::test {

/// A program run on a machine, with everything that was recorded.
struct RunResult {
  emulator::Job job;
  Diagnostics diagnostics;
  RecordingLog log;
  emulator::RunSummary summary;
};

inline emulator::Job make_job(const std::string& program, const machine::MachineModel& machine) {
  emulator::Job job;
  job.program = job.sources.add(SourceText("test.ngc", program));
  job.machine.model = machine;
  return job;
}

inline void run_program(RunResult& r, const std::string& program, const machine::MachineModel& machine,
                        const emulator::RunOptions& options = {}) {
  r.job = make_job(program, machine);
  const bool prepared = emulator::prepare(r.job, r.diagnostics, emulator::SoftLimitRule::warning);
  for (const Diagnostic& d : r.diagnostics.list()) INFO(render_gcc(d, r.job.sources));
  REQUIRE(prepared);
  emulator::RunHeader header;
  header.machine = &r.job.machine.model;
  REQUIRE(r.log.begin(header).has_value());
  auto summary = emulator::run(r.job, &r.log, options);
  REQUIRE(summary.has_value());
  r.summary = *summary;
}

}  // namespace kadr::test
