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
  cycle::JobInputs given;

  std::optional<cycle::Job> prepare(Diagnostics& diagnostics,
                                    cycle::SoftLimitRule soft_limits = cycle::SoftLimitRule::error,
                                    const cycle::PlanFunction& plan = {}) {
    return cycle::prepare(given, sources, diagnostics, soft_limits, plan);
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
  std::optional<cycle::Job> job;
  Diagnostics diagnostics;
  RecordingLog log;
  log::RunSummary summary;
};

/// Runs a job that was prepared, into the result's log.
inline void run_prepared(RunResult& r, const cycle::RunOptions& options = {}) {
  log::RunHeader header;
  header.machine = &r.in.given.machine.model;
  REQUIRE(r.log.begin(header).has_value());
  auto summary = cycle::run(*r.job, &r.log, options);
  REQUIRE(summary.has_value());
  r.summary = *summary;
}

/// Prepares r.in, where a soft limit is a warning.
inline void prepare_run(RunResult& r) {
  auto job = r.in.prepare(r.diagnostics, cycle::SoftLimitRule::warning);
  for (const Diagnostic& d : r.diagnostics.list()) INFO(render_gcc(d, r.in.sources));
  REQUIRE(job);
  r.job.emplace(std::move(*job));
}

inline void run_program(RunResult& r, const std::string& program, const machine::MachineModel& machine,
                        const cycle::RunOptions& options = {}) {
  r.in = make_inputs(program, machine);
  prepare_run(r);
  run_prepared(r, options);
}

}  // namespace kadr::test
