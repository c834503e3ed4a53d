#include <fmt/format.h>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/result_file.h"
#include "emulator/studies/point_to_point/point_page.h"
#include "emulator/studies/point_to_point/point_report.h"

/// `kadr law`: laws from rest to rest, side by side.
namespace kadr::cli {
namespace {

using emulator::Json;

Json document_head(int code) { return {{"kadr", KADR_VERSION}, {"command", "law"}, {"exit_code", code}}; }

int refuse(const planner::PointFault& fault, Console& console) {
  if (console.options().json) {
    Json j = document_head(kNotStarted);
    j["refused"] = emulator::json_of(fault);
    console.document(j);
  } else {
    console.error("law: " + emulator::fault_text(fault));
  }
  return kNotStarted;
}

int print_table2(Console& console) {
  const std::vector<emulator::Table2Row> rows = emulator::table2();
  if (console.options().json) {
    Json j = document_head(kYes);
    j["table2"] = emulator::json_of(rows);
    console.document(j);
  } else if (!console.options().quiet) {
    console.data(emulator::render_table2(rows));
  }
  return kYes;
}

}  // namespace

int compare_laws(const Arguments& arguments, Console& console) {
  if (arguments.table2) return print_table2(console);
  const emulator::PointQuestion& question = arguments.point;
  const auto study = emulator::study_point_laws(question);
  if (!study) return refuse(study.error(), console);
  if (!arguments.csv_path.empty()) write_file(arguments.csv_path, emulator::point_csv(*study));
  if (!arguments.page_path.empty())
    write_file(arguments.page_path, emulator::render_point_page(question, *study));
  if (console.options().json) {
    Json j = document_head(kYes);
    j.update(emulator::json_of(question, *study));
    console.document(j);
  } else if (!console.options().quiet) {
    console.data(emulator::render_point_question(question, *study) + '\n' +
                 emulator::render_point_table(*study) + '\n' + emulator::render_point_answer(*study));
  }
  return kYes;
}

}  // namespace kadr::cli
