// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace skein::report {

inline constexpr std::string_view kDrawing = R"(
svg text{font:11px system-ui,sans-serif;fill:var(--soft)}
svg .ground{fill:var(--ground)}svg .grid{stroke:var(--rule);fill:none}
svg .hatch{stroke:var(--bad);stroke-width:1.6;opacity:.5}
svg .hazard{fill:url(#hatch);stroke:var(--bad);stroke-width:1.2}
svg .s0{--c:var(--s0)}svg .s1{--c:var(--s1)}svg .s2{--c:var(--s2)}svg .s3{--c:var(--s3)}
svg .s4{--c:var(--s4)}svg .s5{--c:var(--s5)}svg .s6{--c:var(--s6)}
svg .f0{fill:var(--s0)}svg .f1{fill:var(--s1)}svg .f2{fill:var(--s2)}svg .f3{fill:var(--s3)}
svg .f4{fill:var(--s4)}svg .f5{fill:var(--s5)}svg .f6{fill:var(--s6)}
svg .d0{fill:var(--d0)}svg .d1{fill:var(--d1)}svg .d2{fill:var(--d2)}svg .d3{fill:var(--d3)}
svg .d4{fill:var(--d4)}svg .d5{fill:var(--d5)}svg .d6{fill:var(--d6)}
svg .track,svg .curve{fill:none;stroke:var(--c);stroke-width:1.4;stroke-linejoin:round}
svg .free{stroke-width:.9;opacity:.75}svg .assessor{stroke-dasharray:5 3}
svg .track:hover,svg .curve:hover{stroke-width:3.5;opacity:1}
svg .start{fill:var(--paper);stroke:var(--ink);stroke-width:1.2}svg .end:not(text){fill:var(--ink)}
svg .site{fill:var(--c);stroke:var(--paper);stroke-width:2}
svg .bearing{stroke:var(--c);stroke-width:2.2}svg .tip{fill:var(--c)}
svg .name{font-weight:650;font-size:14px;fill:var(--ink);text-anchor:middle;paint-order:stroke;stroke:var(--ground);stroke-width:4px}
svg .id{font-size:10px;fill:var(--ink);paint-order:stroke;stroke:var(--ground);stroke-width:2.5px}
svg .mid{text-anchor:middle}svg text.end{text-anchor:end}
svg .badge{text-anchor:middle;font-size:10px;font-weight:650;fill:var(--paper)}
svg .scale{stroke:var(--ink);fill:none;stroke-width:1.3}
svg .pass{fill:var(--paper);stroke:var(--c);stroke-width:2}
svg .allowed{fill:var(--good);opacity:.1}svg .axis{stroke:var(--soft)}
svg .stem{stroke:var(--c);stroke-width:1.5}svg .label{fill:var(--ink);font-size:12px}
)";

inline constexpr std::string_view kPage = R"(
*{box-sizing:border-box}
body{margin:0 auto;max-width:1320px;padding:22px 28px 48px;background:var(--paper);color:var(--ink);font:14px/1.45 system-ui,sans-serif}
h1{font-size:24px;margin:0}h2{font-size:16px;margin:34px 0 10px}h3{font-size:13px;margin:0 0 4px;font-weight:600}
p{margin:4px 0;color:var(--soft)}
header{display:flex;justify-content:space-between;gap:24px;align-items:flex-start;flex-wrap:wrap}
.verdict{padding:9px 16px;border-radius:8px;border:2px solid;text-align:right;font-size:13px}
.verdict b{display:block;font-size:20px;letter-spacing:.04em}
.pass-word{color:var(--good)}.fail-word{color:var(--bad)}
.two{display:grid;grid-template-columns:minmax(0,1.75fr) minmax(0,1fr);gap:26px;align-items:start}
.many{display:grid;grid-template-columns:repeat(auto-fit,minmax(390px,1fr));gap:22px}
@media(max-width:900px){.two{grid-template-columns:minmax(0,1fr)}}
svg{display:block;width:100%;height:auto}
.wide{overflow-x:auto}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
th,td{text-align:left;padding:4px 10px 4px 0;border-bottom:1px solid var(--rule);vertical-align:top}
th{font-weight:600;color:var(--soft);font-size:12px}
td.number{text-align:right;padding-right:18px}td:nth-child(-n+2){white-space:nowrap}.sentences td{white-space:normal}th.number{text-align:right}tr.site td{padding-top:12px;font-weight:650}
.dot{display:inline-block;width:11px;height:11px;border-radius:50%;margin-right:7px}
.sentences td{color:var(--bad);padding-left:26px}.sentences ul{margin:0;padding-left:16px}
.soft{color:var(--soft)}
a.moment{color:var(--s1);white-space:nowrap;display:inline-block;min-width:44px}
figure{margin:0}
.plot svg{touch-action:pan-y}
.plot .hidden{display:none}.plot .hover{fill:var(--paper);stroke:var(--ink);stroke-width:2;pointer-events:none}
button{font:inherit;color:var(--ink);background:var(--ground);border:1px solid var(--rule);border-radius:6px;padding:4px 10px;cursor:pointer}
.legend{display:flex;flex-wrap:wrap;gap:6px;margin:8px 0}
.legend button{font-size:12px;border-left:4px solid var(--c,var(--rule))}
.legend button[aria-pressed=false]{color:var(--soft);text-decoration:line-through;border-left-color:var(--rule)}
@media(pointer:coarse){button{min-height:44px;min-width:44px}}
#tip{position:fixed;z-index:2;max-width:min(90vw,460px);padding:5px 9px;border-radius:6px;background:var(--ink);color:var(--paper);font-size:12px;pointer-events:none}
#said{position:fixed;z-index:2;left:0;right:0;bottom:0;padding:10px 28px;background:var(--ink);color:var(--paper);overflow-wrap:anywhere}
[hidden]{display:none}
)";

}  // namespace skein::report
