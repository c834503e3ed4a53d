#include <fmt/format.h>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/result_file.h"
#include "emulator/studies/point_to_point/point_page.h"
#include "emulator/studies/point_to_point/point_report.h"

/// `kadr law`: laws from rest to rest, side by side.
namespace kadr::cli {
namespace {

using text::Json;

Json document_head(int code) { return {{"kadr", KADR_VERSION}, {"command", "law"}, {"exit_code", code}}; }

int refuse(const planner::PointFault& fault, Console& console) {
  if (console.options().json) {
    Json j = document_head(kNotStarted);
    j["refused"] = studies::json_of(fault);
    console.document(j);
  } else {
    console.error("law: " + studies::fault_text(fault));
  }
  return kNotStarted;
}

int print_table2(Console& console) {
  const std::vector<studies::Table2Row> rows = studies::table2();
  if (console.options().json) {
    Json j = document_head(kYes);
    j["table2"] = studies::json_of(rows);
    console.document(j);
  } else if (!console.options().quiet) {
    console.data(studies::render_table2(rows));
  }
  return kYes;
}

}  // namespace

int compare_laws(const Arguments& arguments, Console& console) {
  if (arguments.table2) return print_table2(console);
  const studies::PointQuestion& question = arguments.point;
  const auto study = studies::study_point_laws(question);
  if (!study) return refuse(study.error(), console);
  for (const std::string* path : {&arguments.csv_path, &arguments.page_path}) console.claim_output(*path);
  if (!arguments.csv_path.empty()) write_file(arguments.csv_path, studies::point_csv(*study));
  if (!arguments.page_path.empty())
    write_file(arguments.page_path, studies::render_point_page(question, *study));
  if (console.options().json) {
    Json j = document_head(kYes);
    j.update(studies::json_of(question, *study));
    console.document(j);
  } else if (!console.options().quiet) {
    console.summary(studies::render_point_question(question, *study) + '\n' +
                    studies::render_point_table(*study) + '\n' + studies::render_point_answer(*study));
  }
  return kYes;
}

}  // namespace kadr::cli
