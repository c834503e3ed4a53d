#include <fmt/format.h>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/result_file.h"
#include "emulator/log_tools/report/built_pages.h"
#include "emulator/studies/teach/bezier_report.h"
#include "emulator/studies/teach/sweep.h"
#include "emulator/studies/teach/teach_page.h"
#include "emulator/studies/teach/teach_report.h"
#include "emulator/text/text.h"

/// `kadr teach`: interpolators step by step.
namespace kadr::cli {
namespace {

namespace lattice = interpolator::lattice;

using studies::StepTable;
using studies::TeachCase;
using text::Json;

// as the base clock of the shipped machines; a tick is 0.1 us
constexpr std::int64_t kClock_hz = 10'000'000;
constexpr std::int64_t kHigh_ticks = 20;
constexpr std::size_t kCompared = 4;

template <class T>
T must(tl::expected<T, std::string> result) {
  if (!result) throw WorldError(result.error());
  return std::move(*result);
}

Json head(const char* command) { return {{"kadr", KADR_VERSION}, {"command", command}, {"exit_code", kYes}}; }

}  // namespace

int teach_table(const Arguments& arguments, Console& console) {
  const TeachArguments& teach = arguments.teach;
  console.claim_output(teach.vcd_path);
  const TeachCase subject = must(studies::read_teach_case(arguments.files, teach.axes));
  const auto method =
      arguments.methods.empty() ? lattice::Method::half_step : *lattice::method_of(arguments.methods.front());
  const auto by_default = [&](const lattice::Curve& curve) {
    const bool chosen = !arguments.methods.empty() || lattice::knows(method, curve);
    return chosen ? method : lattice::Method::crossing;
  };
  const StepTable table = must(studies::step_table(subject, by_default(subject.legs.front()), teach.options));
  const bool timed = !teach.vcd_path.empty() || teach.spacing;
  studies::PulseTrain train;
  if (timed) train = must(studies::pulse_train(table, teach.timing, teach.feed_steps_s, kClock_hz));
  if (!teach.vcd_path.empty()) {
    write_file(teach.vcd_path, studies::render_vcd(train, kHigh_ticks));
    console.note(fmt::format("wrote {}: {} in {} us", output_text(teach.vcd_path),
                             text::counted(table.pulses, "pulse"),
                             text::fixed(static_cast<double>(train.duration.value) / 10, 1)));
  }
  if (console.options().json) {
    Json j = head("teach table");
    j.update(studies::json_of(subject, table));
    if (timed) j["timing"] = studies::json_of(train);
    console.document(j);
  } else if (arguments.csv) {
    console.summary(studies::render_step_csv(table));
  } else if (!console.options().quiet) {
    console.summary(studies::render_step_table(subject, table));
    if (teach.spacing) console.summary(studies::render_spacing(train));
  }
  return kYes;
}

int teach_compare(const Arguments& arguments, Console& console) {
  const TeachCase subject = must(studies::read_teach_case(arguments.files, arguments.teach.axes));
  std::vector<lattice::Method> methods;
  for (const std::string& name : arguments.methods) methods.push_back(*lattice::method_of(name));
  if (methods.empty())
    for (const auto& m : lattice::methods())
      if (methods.size() < kCompared && lattice::knows(m.method, subject.legs.front()))
        methods.push_back(m.method);
  std::vector<StepTable> tables;
  tables.reserve(methods.size());
  for (const auto method : methods)
    tables.push_back(must(studies::step_table(subject, method, arguments.teach.options)));
  if (console.options().json) {
    Json j = head("teach compare");
    j.update(studies::comparison_json(subject, tables));
    console.document(j);
  } else if (arguments.csv) {
    console.data(studies::render_comparison_csv(tables));
  } else if (!console.options().quiet) {
    console.data(studies::render_comparison(subject, tables));
  }
  return kYes;
}

int teach_page(const Arguments& arguments, Console& console) {
  if (studies::teach_template().empty()) {
    console.error(fmt::format(
        "this build has no teaching page: {}. `kadr teach table` and `kadr teach compare` print the "
        "same numbers",
        log_tools::page_missing("teaching")));
    return kNotStarted;
  }
  // a case that can't be read or followed is refused here, not by the page
  if (!arguments.files.empty()) {
    const TeachCase subject = must(studies::read_teach_case(arguments.files, 2));
    if (subject.axes != 2 || subject.legs.size() != 1)
      throw WorldError(fmt::format("{}: the page shows one curve in two axes; `kadr teach table` takes more",
                                   subject.title));
    for (const std::string& name : arguments.methods)
      must(studies::step_table(subject, *lattice::method_of(name), {}));
  }
  const std::string page =
      studies::render_teach_page(studies::teach_address(arguments.files, arguments.methods));
  const std::string& path = arguments.teach.page_path;
  if (path == "-") {
    console.bytes(page);
    return kYes;
  }
  write_file(path, page);
  console.note(fmt::format("wrote {}: {}", path, text::bytes_text(static_cast<std::int64_t>(page.size()))));
  return kYes;
}

int teach_sweep(const Arguments& arguments, Console& console) {
  const std::uint32_t cases = arguments.teach.cases;
  const std::string hash = fmt::format("{:016x}", studies::sweep_hash(0, cases));
  if (console.options().json) {
    Json j = head("teach sweep");
    j["cases"] = cases;
    j["sweep_hash"] = hash;
    console.document(j);
  } else {
    console.data(fmt::format("{} cases, hash {}\n", text::grouped(cases), hash));
  }
  return kYes;
}

int teach_methods(const Arguments&, Console& console) {
  if (console.options().json) {
    Json j = head("teach methods");
    j["methods"] = Json::array();
    for (const auto& m : lattice::methods())
      j["methods"].push_back({{"name", m.name()}, {"meaning", m.meaning()}});
    console.document(j);
    return kYes;
  }
  using Align = text::TextTable::Align;
  text::TextTable table({{"method", Align::left}, {"what decides", Align::left}});
  for (const auto& m : lattice::methods()) table.add({std::string(m.name()), std::string(m.meaning())});
  console.data(table.render());
  return kYes;
}

int teach_bezier(const Arguments& arguments, Console& console) {
  const TeachArguments& teach = arguments.teach;
  const auto curves = must(studies::read_beziers(arguments.files));
  const studies::BezierStudy study = studies::study_beziers(curves, teach.paper);
  const studies::BezierDemand demand{teach.feed_mm_s, teach.acceleration_mm_s2};
  const int code = studies::allowed(study, demand) ? kYes : kNo;
  if (console.options().json) {
    Json j = head("teach bezier");
    j["exit_code"] = code;
    j.update(studies::json_of(study, demand));
    console.document(j);
  } else if (!console.options().quiet) {
    console.data(studies::render_beziers(study, demand));
  }
  return code;
}

}  // namespace kadr::cli
