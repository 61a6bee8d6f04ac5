// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace skein::report {

/// The colours of every picture and page of a report, for light and dark: paper, ink, series (--s1
/// to --s6, --s0 for none), what vehicles do (--d0 to --d6). After Okabe and Ito (2008), who chose
/// them so that people with any colour vision tell them apart.
inline constexpr std::string_view kPalette = R"(
:root{--paper:#fff;--ground:#f7f8fa;--ink:#1c2530;--soft:#5b6774;--rule:#dfe3e8;
--s0:#a3abb5;--s1:#0072b2;--s2:#d55e00;--s3:#00875f;--s4:#b8578f;--s5:#c98500;--s6:#3a9fd6;
--d0:#dde1e6;--d1:#cc79a7;--d2:#f0e442;--d3:#a9cbe8;--d4:#56b4e9;--d5:#d55e00;--d6:#009e73;
--good:#00734f;--bad:#b3261e}
@media(prefers-color-scheme:dark){:root{--paper:#14181d;--ground:#1b2027;--ink:#e6eaef;--soft:#98a3af;--rule:#2f3741;
--s0:#69737f;--s1:#5ab4f0;--s2:#ff8f4a;--s3:#35c99a;--s4:#e79fc8;--s5:#f0b73c;--s6:#8fd3fa;
--d0:#323a44;--d1:#b8699a;--d2:#d3c63a;--d3:#33597a;--d4:#56b4e9;--d5:#ef7a2a;--d6:#16b385;
--good:#3ecf9c;--bad:#ff8a80}}
)";

/// Classes c0 to c6 set --c to one colour of a series.
inline constexpr std::string_view kSeries = R"(
.c0{--c:var(--s1)}.c1{--c:var(--s2)}.c2{--c:var(--s3)}.c3{--c:var(--s4)}.c4{--c:var(--s5)}.c5{--c:var(--s6)}.c6{--c:var(--soft)}
)";
inline constexpr std::size_t kSeriesColours = 7;

}  // namespace skein::report
