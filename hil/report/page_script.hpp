// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace skein::report {

/// What moves in the page: the figure under the pointer, legends that hide what they name, and the
/// command line of a replay that goes to the clipboard when its link is followed. The page is
/// whole without it.
///
/// A plot is a `figure.plot`. In it `data-series` says whose an element is, names separated by "|";
/// `data-time` and `data-value` of an svg have the scales of its axes ("from to pixel_from
/// pixel_to", and the unit); `data-times` of a track when it was at each of its points.
inline constexpr std::string_view kScript = R"~(
"use strict";
const all = (selector, root = document) => [...root.querySelectorAll(selector)];
const tip = document.getElementById("tip");
const said = document.getElementById("said");
const pixels_near = 24;

/* The native tip comes late, and would lie over ours. */
for (const title of all(".plot title")) {
  const of = title.parentNode;
  of.dataset.title = title.textContent;
  title.remove();
}

const axis_of = (text) => {
  if (!text) return null;
  const [from, to, pixel_from, pixel_to, unit = ""] = text.split(" ");
  const scale = (to - from) / (pixel_to - pixel_from);
  return { value: (pixel) => Number(from) + (pixel - pixel_from) * scale, unit, step: Math.abs(scale) };
};
const points_of = (line) => {
  line.read ??= line.getAttribute("points").split(" ").map((pair) => pair.split(",").map(Number));
  return line.read;
};
/* As many decimals as a pixel can tell apart. */
const rounded = (value, step) => value.toFixed(Math.max(0, Math.min(2, Math.ceil(-Math.log10(step)))));
const seconds = (time, step) => `${rounded(time, step)} s`;

/* The nearest point of a line: over time at the pointer's time, of a track anywhere. */
function nearest_on(line, x, y, over_time) {
  const points = points_of(line);
  let best = null;
  for (let i = 1; points.length > i; ++i) {
    const [ax, ay] = points[i - 1];
    const [bx, by] = points[i];
    if (over_time && (ax > x || x > bx)) continue;
    const length = over_time ? bx - ax : (bx - ax) ** 2 + (by - ay) ** 2;
    const along = over_time ? x - ax : (x - ax) * (bx - ax) + (y - ay) * (by - ay);
    const share = length > 0 ? Math.max(0, Math.min(1, along / length)) : 0;
    const at = [ax + share * (bx - ax), ay + share * (by - ay)];
    const off = over_time ? Math.abs(at[1] - y) : Math.hypot(at[0] - x, at[1] - y);
    if (best === null || best.off > off) best = { off, at, index: i - 1 + share };
  }
  return best;
}

const shows = (element) => !element.classList.contains("hidden");
const who_of = (element) => element.dataset.title || element.dataset.series.replaceAll("|", ", ");

function figure_at(svg, event) {
  const matrix = svg.getScreenCTM();
  if (!matrix) return null;
  const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
  const titled = event.target.closest("[data-title]");
  if (titled && titled.tagName !== "polyline" && titled.tagName !== "svg" && !titled.classList.contains("allowed")) {
    return { text: titled.dataset.title };
  }
  const time = axis_of(svg.dataset.time);
  const value = axis_of(svg.dataset.value);
  let best = null;
  for (const line of all("polyline[data-series]", svg)) {
    if (!shows(line)) continue;
    const near = nearest_on(line, x, y, time !== null);
    if (near && (best === null || best.near.off > near.off)) best = { line, near };
  }
  if (best === null || (time === null && best.near.off > pixels_near)) return titled ? { text: titled.dataset.title } : null;
  const { line, near } = best;
  const parts = [];
  if (time) {
    parts.push(seconds(time.value(near.at[0]), time.step), who_of(line), `${rounded(value.value(near.at[1]), value.step)} ${value.unit}`);
  } else {
    const times = line.dataset.times?.split(" ").map(Number);
    const before = Math.floor(near.index);
    if (times) {
      const after = Math.min(before + 1, times.length - 1);
      parts.push(seconds(times[before] + (near.index - before) * (times[after] - times[before]), 1));
    }
    parts.push(who_of(line));
    const east = axis_of(svg.dataset.east);
    const north = axis_of(svg.dataset.north);
    if (east && north) parts.push(`E ${rounded(east.value(near.at[0]), east.step)} N ${rounded(north.value(near.at[1]), north.step)} m`);
  }
  return { text: parts.join(" · "), at: near.at, svg };
}

function hide_tip(figure) {
  tip.hidden = true;
  for (const dot of all(".hover", figure)) dot.remove();
}

function show_tip(figure, event) {
  hide_tip(figure);
  const svg = event.target.closest("svg");
  const found = svg && figure_at(svg, event);
  if (!found) return;
  if (found.at) {
    const dot = document.createElementNS("http://www.w3.org/2000/svg", "circle");
    dot.setAttribute("class", "hover");
    dot.setAttribute("cx", found.at[0]);
    dot.setAttribute("cy", found.at[1]);
    dot.setAttribute("r", "4");
    found.svg.append(dot);
  }
  tip.textContent = found.text;
  tip.hidden = false;
  const right = event.clientX + 14 + tip.offsetWidth > innerWidth;
  tip.style.left = `${right ? Math.max(0, event.clientX - 14 - tip.offsetWidth) : event.clientX + 14}px`;
  tip.style.top = `${Math.max(0, event.clientY - 14 - tip.offsetHeight)}px`;
}

/* What a legend has switched off hides all that is of it. */
function add_legend(figure) {
  const elements = all("[data-series]", figure);
  const names = [...new Set(elements.flatMap((element) => element.dataset.series.split("|")))];
  if (2 > names.length) return;
  const off = new Set();
  const keys = new Map();
  const draw = () => {
    for (const element of elements) {
      element.classList.toggle("hidden", element.dataset.series.split("|").some((name) => off.has(name)));
    }
    for (const [name, key] of keys) key.setAttribute("aria-pressed", String(!off.has(name)));
  };
  const legend = document.createElement("div");
  legend.className = "legend";
  legend.setAttribute("role", "group");
  legend.setAttribute("aria-label", "What is shown");
  const add = (name, pressed) => {
    const key = document.createElement("button");
    key.type = "button";
    key.textContent = name;
    key.addEventListener("click", () => {
      pressed();
      draw();
    });
    legend.append(key);
    return key;
  };
  for (const name of names) {
    const key = add(name, () => (off.delete(name) ? undefined : off.add(name)));
    const one = elements.find((element) => element.dataset.series === name) ?? elements.find((element) => element.dataset.series.split("|").includes(name));
    const { stroke, fill } = getComputedStyle(one);
    key.style.setProperty("--c", fill !== "none" ? fill : stroke);
    keys.set(name, key);
  }
  add("all", () => off.clear());
  add("none", () => names.forEach((name) => off.add(name)));
  figure.append(legend);
  draw();
}

for (const figure of all(".plot")) {
  figure.addEventListener("pointermove", (event) => show_tip(figure, event));
  figure.addEventListener("pointerdown", (event) => show_tip(figure, event));
  figure.addEventListener("pointerleave", () => hide_tip(figure));
  add_legend(figure);
}

async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const field = document.createElement("textarea");
    field.value = text;
    document.body.append(field);
    field.select();
    const copied = document.execCommand("copy");
    field.remove();
    return copied;
  }
}

document.addEventListener("click", (event) => {
  const link = event.target.closest("[data-command]");
  if (!link) return;
  const { command } = link.dataset;
  void copy(command).then((copied) => {
    said.hidden = false;
    said.textContent = `${copied ? "Copied" : "To type"}: ${command}`;
  });
});
)~";

}  // namespace skein::report
