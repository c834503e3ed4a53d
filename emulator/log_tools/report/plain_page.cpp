#include <fmt/format.h>

#include "emulator/log_tools/report/built_pages.h"
#include "emulator/log_tools/report/page_style.h"
#include "emulator/log_tools/report/report_page.h"
#include "emulator/log_tools/report/summary_html.h"
#include "emulator/text/text.h"

namespace kadr::log_tools {
std::string render_plain_page(const PageData& data) {
  const std::string title = text::xml_text(page_title(data));
  return fmt::format(
      "{}<title>{}</title>\n</head>\n<body>\n<h1>{}</h1>\n{}{}"
      "<p>kadr {}{}</p>\n</body>\n</html>\n",
      kPlainHead, title, title, summary_html(data), chart_html(data), KADR_VERSION, plain_note("report"));
}

}  // namespace kadr::log_tools
