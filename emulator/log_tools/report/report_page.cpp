#include "emulator/log_tools/report/report_page.h"

#include <algorithm>

#include "emulator/log_tools/report/run_data.h"
#include "emulator/log_tools/report/summary_html.h"
#include "emulator/text/text.h"
#include "machine/base/require.h"

namespace kadr::log_tools {
namespace {

constexpr std::size_t kFewestPieces = 2048;
/// of the page's size for each corner of the path, which takes about 6
constexpr std::size_t kBytesACorner = 25;

/// Replaces a mark of the template, which occurs once, by a text.
void fill(std::string& page, std::string_view mark, std::string_view text) {
  const auto at = page.find(mark);
  require(at != std::string::npos, "the page's template has every mark");
  page.replace(at, mark.size(), text);
}

/// Control ticks of which a quarter of the page's data has room at full rate.
std::int64_t full_rate_ticks(const PageData& data, std::size_t scripts, std::size_t room) {
  const double bytes_a_piece =
      static_cast<double>(scripts) / static_cast<double>(std::max<std::size_t>(1, data.pieces()));
  return static_cast<std::int64_t>(0.25 * static_cast<double>(room) / bytes_a_piece);
}

}  // namespace

std::string fitted_run(PageData& data, std::size_t most_bytes, const std::string& prefix, bool with_path,
                       const ReadFullRate& again) {
  double tolerance_mm = kChord_mm;
  data.corners = thinned(std::move(data.corners), picture_steps_mm(data.header), tolerance_mm,
                         most_bytes / kBytesACorner);
  std::string scripts = run_scripts(data, prefix, with_path);
  const bool overview = scripts.size() > most_bytes || data.every > 1;
  if (overview && again) {
    data.full_rate =
        again(data, stretches_of_interest(data, full_rate_ticks(data, scripts.size(), most_bytes)));
    scripts = run_scripts(data, prefix, with_path);
  }
  while (scripts.size() > most_bytes && data.pieces() > kFewestPieces) {
    // the first halving doubles the rows of a track: it gains nothing
    if (data.every == 1) halve(data);
    halve(data);
    scripts = run_scripts(data, prefix, with_path);
  }
  return scripts;
}

std::string filled_template(const std::string& title, const std::string& summary, const std::string& charts,
                            const std::string& data) {
  std::string page(report_template());
  fill(page, "<!--TITLE-->", title);
  fill(page, "<!--HEADING-->", title);
  fill(page, "<!--SUMMARY-->", summary);
  fill(page, "<!--CHARTS-->", charts);
  fill(page, "<!--DATA-->", data);
  return page;
}

std::string render_report_page(PageData data, std::size_t max_bytes, const ReadFullRate& again) {
  if (report_template().empty()) return render_plain_page(data);
  const std::string title = text::xml_text(page_title(data)), summary = summary_html(data),
                    charts = chart_html(data);
  const std::size_t frame = report_template().size() + 2 * title.size() + summary.size() + charts.size();
  const std::size_t room = max_bytes > frame ? max_bytes - frame : 0;
  return filled_template(title, summary, charts, fitted_run(data, room, "", false, again));
}

}  // namespace kadr::log_tools
