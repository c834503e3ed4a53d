#pragma once
#include "emulator/cli/arguments.h"
#include "emulator/cli/console.h"

/// One function per command: does the work, prints, and returns the exit code. I/O errors are thrown
/// as WorldError or std::system_error, faults of kadr as BrokenPromise; main() turns them into exit codes.
namespace kadr::cli {

int run_program(const Arguments& arguments, Console& console);
int check_programs(const Arguments& arguments, Console& console);
int plan_program(const Arguments& arguments, Console& console);
int canon_program(const Arguments& arguments, Console& console);
int format_programs(const Arguments& arguments, Console& console);
int diff_logs(const Arguments& arguments, Console& console);
int solve_tube(const Arguments& arguments, Console& console);
int compare_laws(const Arguments& arguments, Console& console);
int export_log(const Arguments& arguments, Console& console);
int report_log(const Arguments& arguments, Console& console);
int compare_logs(const Arguments& arguments, Console& console);
int plot_log(const Arguments& arguments, Console& console);
int log_info(const Arguments& arguments, Console& console);
int machine_show(const Arguments& arguments, Console& console);
int machine_list(const Arguments& arguments, Console& console);
int machine_keys(const Arguments& arguments, Console& console);
int machine_check(const Arguments& arguments, Console& console);
int machine_new(const Arguments& arguments, Console& console);
int explain_codes(const Arguments& arguments, Console& console);
int scenario_run(const Arguments& arguments, Console& console);
int scenario_check(const Arguments& arguments, Console& console);
int scenario_list(const Arguments& arguments, Console& console);
int write_winding(const Arguments& arguments, Console& console);
int teach_table(const Arguments& arguments, Console& console);
int teach_compare(const Arguments& arguments, Console& console);
int teach_methods(const Arguments& arguments, Console& console);
int teach_page(const Arguments& arguments, Console& console);
int teach_sweep(const Arguments& arguments, Console& console);
int teach_bezier(const Arguments& arguments, Console& console);
int print_version(const Arguments& arguments, Console& console);
int print_manual(const Arguments& arguments, Console& console);
int print_completion(const Arguments& arguments, Console& console);

}  // namespace kadr::cli
