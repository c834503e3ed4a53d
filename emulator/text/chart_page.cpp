#include "emulator/text/chart_page.h"

#include <fmt/format.h>

#include "emulator/text/text.h"

namespace kadr::text {
namespace {

constexpr std::string_view kBegin = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'">
<style>
:root { color-scheme: light dark; --ground: #ffffff; --ink: #1c2024; --soft: #5c646d; --rule: #dfe3e8; --blue: #0072b2;
  --orange: #c14f00; --green: #007d5c; --pink: #a8487f; --brown: #8a5a00; --band: #009e73; }
@media (prefers-color-scheme: dark) { :root { --ground: #14171a; --ink: #e6e9ec; --soft: #9aa3ad; --rule: #2c3238;
  --blue: #56b4e9; --orange: #f0883e; --green: #2fbf93; --pink: #e39ac4; --brown: #e6c04a; --band: #2fbf93; } }
body { margin: 0 auto; padding: 1.5rem; max-width: 1040px; background: var(--ground); color: var(--ink);
  font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.4rem; margin: 0; } h2 { font-size: 1.1rem; margin: 2rem 0 0.25rem; }
p { margin: 0.25rem 0 0.75rem; color: var(--soft); }
svg { display: block; width: 100%; height: auto; font: 12px system-ui, sans-serif; }
svg text { fill: var(--ink); } svg text.x { text-anchor: middle; } svg text.y { text-anchor: end; }
svg text.name { fill: var(--soft); }
.grid { stroke: var(--rule); fill: none; } .frame { stroke: var(--soft); fill: none; }
)html";
constexpr std::string_view kPrint =
    R"html(@media print { :root { --ground: #ffffff; --ink: #000000; --soft: #444444; } }
</style>
)html";

}  // namespace

std::string chart_page_head(std::string_view title, std::string_view style) {
  return fmt::format("{}{}{}<title>{}</title>\n</head>\n<body>\n", kBegin, style, kPrint, xml_text(title));
}

}  // namespace kadr::text
