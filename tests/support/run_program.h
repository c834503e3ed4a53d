#pragma once
#include <doctest/doctest.h>

#include <optional>
#include <string>

#include "emulator/emulator.h"
#include "tests/support/recording_log.h"

namespace kadr::test {

/// What a job is given, with its sources. Stays where it is while a job refers to it.
struct TestInputs {
  SourceSet sources;
  emulator::JobInputs given;

  std::optional<emulator::Job> prepare(Diagnostics& diagnostics,
                                       emulator::SoftLimitRule soft_limits = emulator::SoftLimitRule::error,
                                       const emulator::PlanFunction& plan = {}) {
    return emulator::prepare(given, sources, diagnostics, soft_limits, plan);
  }
};

inline TestInputs make_inputs(const std::string& program, const machine::MachineModel& machine) {
  TestInputs in;
  in.given.program = in.sources.add(SourceText("test.ngc", program));
  in.given.machine.model = machine;
  return in;
}

/// A program run on a machine, with everything that was recorded.
struct RunResult {
  TestInputs in;
  std::optional<emulator::Job> job;
  Diagnostics diagnostics;
  RecordingLog log;
  emulator::RunSummary summary;
};

/// Runs a job that was prepared, into the result's log.
inline void run_prepared(RunResult& r, const emulator::RunOptions& options = {}) {
  emulator::RunHeader header;
  header.machine = &r.in.given.machine.model;
  REQUIRE(r.log.begin(header).has_value());
  auto summary = emulator::run(*r.job, &r.log, options);
  REQUIRE(summary.has_value());
  r.summary = *summary;
}

/// Prepares r.in, where a soft limit is a warning.
inline void prepare_run(RunResult& r) {
  auto job = r.in.prepare(r.diagnostics, emulator::SoftLimitRule::warning);
  for (const Diagnostic& d : r.diagnostics.list()) INFO(render_gcc(d, r.in.sources));
  REQUIRE(job);
  r.job.emplace(std::move(*job));
}

inline void run_program(RunResult& r, const std::string& program, const machine::MachineModel& machine,
                        const emulator::RunOptions& options = {}) {
  r.in = make_inputs(program, machine);
  prepare_run(r);
  run_prepared(r, options);
}

}  // namespace kadr::test
