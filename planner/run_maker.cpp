#include "planner/run_maker.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "machine/base/require.h"
#include "machine/machine.h"
#include "planner/scheduler/blockwise.h"
#include "planner/scheduler/ramp_method.h"
#include "planner/time_law/law_methods.h"

namespace kadr::planner {
namespace {

using machine::PlanMethod;

/// A law that a machine may choose, as law_methods.cpp lists it.
class LawRunMethod final : public RunMethod {
 public:
  explicit LawRunMethod(const RunTask& task) : task_(task) {}
  tl::expected<void, PlanError> plan(const Run& run, PlannedRun& out) override {
    return law_method(task_.machine.planner.method).plan(task_, run, out);
  }

 private:
  RunTask task_;
};

template <class Method>
std::unique_ptr<RunMethod> make(const RunTask& task) {
  return std::make_unique<Method>(task);
}

/// The methods that are no time laws; those are in the table of law_methods.cpp.
struct RunMethodRow {
  PlanMethod method;
  std::unique_ptr<RunMethod> (*make)(const RunTask&);
};
constexpr RunMethodRow kRunMethods[] = {
    {PlanMethod::scheduler, make<RampMethod>},
};

constexpr bool covers_methods() {
  for (const machine::PlanMethodRow& method : machine::kPlanMethodRows) {
    const auto rows = std::count_if(std::begin(kRunMethods), std::end(kRunMethods),
                                    [&](const RunMethodRow& row) { return row.method == method.method; });
    if (rows != (method.is_law ? 0 : 1)) return false;
  }
  return true;
}
static_assert(covers_methods(), "a planner.method that is no law has a row in kRunMethods");

std::unique_ptr<RunMethod> run_method(const RunTask& task) {
  for (const RunMethodRow& row : kRunMethods)
    if (row.method == task.machine.planner.method) return row.make(task);
  return make<LawRunMethod>(task);
}

double sum_of_times_s(const std::vector<Element>& run) {
  double sum = 0.0;
  for (const Element& e : run) sum += e.time_s();
  return sum;
}

double sum_of_times_s(const std::vector<JerkPiece>& run) {
  double sum = 0.0, lost = 0.0;  // compensated: the last piece ends a run exactly
  for (const JerkPiece& p : run) {
    const double y = p.duration_s - lost;
    const double next = sum + y;
    lost = (next - sum) - y;
    sum = next;
  }
  return sum;
}

}  // namespace

RunMaker::RunMaker(const Joints& joints, const machine::MachineModel& machine, const PathLimitTable& table)
    : task_{joints, table, machine}, method_(run_method(task_)), rapids_(machine) {}

bool RunMaker::next() {
  if (behind_ >= task_.path().size()) return false;
  run_.first = run_.last = behind_;
  while (task_.table.cap_u_s[2 * run_.last + 2] > 0.0) ++run_.last;
  behind_ = run_.last + 1;
  planned_.elements.clear();
  planned_.pieces.clear();
  positioned_.reset();
  whole_ = {};
  if (!is_positioning(task_.path(), run_.first, task_.machine)) return plan_by_method();
  position();
  return true;
}

bool RunMaker::plan_by_method() {
  auto planned = method_->plan(run_, planned_);
  if (!planned) {
    error_ = std::move(planned.error());
    return false;
  }
  const bool by_pieces = !planned_.pieces.empty();
  require(by_pieces == planned_.elements.empty(), "a run is elements or pieces");
  time_s_ = by_pieces ? sum_of_times_s(planned_.pieces) : sum_of_times_s(planned_.elements);
  if (task_.machine.planner.whole_ticks && time_s_ < kLongest_s) {
    const double tau_s = task_.machine.clock.tau_s();
    whole_ = by_pieces ? stretched_to_ticks(time_s_, tau_s) : fill_whole_ticks(planned_.elements, tau_s);
  }
  return true;
}

void RunMaker::position() {
  const std::size_t i = run_.first;
  require(run_.last == i, "a positioning move is a run of its own");
  const PathLimitTable& table = task_.table;
  const Positioning rapid =
      rapids_.plan(task_.path(), i, table.cap_u_s[2 * i + 1], table.accel_u_s2[i], table.jerk_u_s3[i]);
  append_pieces(rapid.law, task_.path().start_s_u[i], table.signature[2 * i + 1], planned_.pieces);
  time_s_ = rapid.law.duration_s();
  if (task_.machine.planner.whole_ticks)
    whole_.ticks = static_cast<std::int64_t>(std::floor(time_s_ / task_.machine.clock.tau_s() + 0.5));
  positioned_ = {static_cast<std::uint32_t>(i), rapid.shape, rapid.reason, rapid.loss_s, {}};
  for (const ExcitedMode& m : rapids_.excited(task_.path(), i))
    positioned_->residual_u[static_cast<std::size_t>(m.axis)] += residual_u(rapid.law, m);
}

void RunMaker::write(PieceWriter& writer, double end_time_s) const {
  if (planned_.pieces.empty())
    writer.add(planned_.elements, whole_.stretch, end_time_s);
  else
    writer.add(planned_.pieces, whole_.stretch, end_time_s);
}

}  // namespace kadr::planner
