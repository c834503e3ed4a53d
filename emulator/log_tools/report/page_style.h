#pragma once
#include <string_view>

namespace kadr::log_tools {

/// Beginning of a page without script, up to its title: security policy and style sheet for tables and charts.
inline constexpr std::string_view kPlainHead = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'">
<style>
:root { color-scheme: light dark; --ground: #ffffff; --ink: #1c2024; --soft: #5c646d; --rule: #dfe3e8; --blue: #0072b2; --orange: #c14f00;
  --green: #007d5c; --pink: #a8487f; }
@media (prefers-color-scheme: dark) { :root { --ground: #14171a; --ink: #e6e9ec; --soft: #9aa3ad; --rule: #2c3238; --blue: #56b4e9;
  --orange: #f0883e; --green: #2fbf93; --pink: #e39ac4; } }
body { margin: 0 auto; padding: 1.5rem; max-width: 1040px; background: var(--ground); color: var(--ink); font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.4rem; margin: 0 0 1rem; } .scroll { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 13px; }
th, td { padding: 0.15rem 0.6rem; text-align: right; border-bottom: 1px solid var(--rule); white-space: nowrap; font-weight: normal; }
thead th { color: var(--soft); } th:first-child { text-align: left; padding-left: 0; } #alarms td:last-child, #alarms th:last-child { text-align: left; }
caption { text-align: left; font-weight: 600; padding-bottom: 0.25rem; } pre { margin: 0; font-size: 12px; } p { color: var(--soft); }
svg { display: block; width: 100%; height: auto; font: 12px system-ui, sans-serif; } svg text { fill: var(--ink); } svg text.x { text-anchor: middle; }
svg text.y { text-anchor: end; } svg text.name { fill: var(--soft); } .grid { stroke: var(--rule); fill: none; } .frame { stroke: var(--soft); fill: none; }
.line { fill: none; stroke-width: 1.2; stroke-linejoin: round; } .s0 { stroke: var(--blue); } .s1 { stroke: var(--orange); stroke-dasharray: 7 3; }
.s2 { stroke: var(--green); stroke-dasharray: 2 3; } .s3 { stroke: var(--pink); stroke-dasharray: 10 3 2 3; } .s4 { stroke: var(--soft); }
.s5 { stroke: var(--ink); stroke-dasharray: 4 2; } h2 { font-size: 1.1rem; margin: 1.5rem 0 0; }
@media print { :root { --ground: #ffffff; --ink: #000000; --soft: #444444; } }
</style>
)html";

}  // namespace kadr::log_tools
