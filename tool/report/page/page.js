// What all pages of reports share. Everything lies in the page itself.
"use strict";
const byId = (id) => document.getElementById(id);
const pageData = JSON.parse(byId("data").textContent);

function add(parent, tag, text, attributes = {}) {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  parent.append(element);
  return element;
}

const MIB = 1024 * 1024;
const whole = (value) => value.toLocaleString("en");
const ratio = (value) => (value === null ? "–" : value.toFixed(2) + "×");

function machineText(report) {
  return `${report.device} (${report.driver}), ${report.api}; medians of ${report.repeats} ${report.repeats === 1 ? "round" : "rounds"}.` +
    (report.cpu && report.api !== "CPU" ? " This device is a CPU, whose times are the machine's: ratios alone are shown." : "");
}

function chartColors() {
  const style = getComputedStyle(document.documentElement);
  return { ink: style.getPropertyValue("--ink").trim(), line: style.getPropertyValue("--line").trim() };
}

const PALETTE = ["#5b8def", "#e2884a", "#3fa77a", "#c069c4", "#c9a227", "#d0605e", "#6aa9b8", "#8a8f99", "#7a6fd6",
  "#a3703f", "#7fae2e", "#e07ab0", "#2f8f9f", "#b5544a", "#9a9a3c", "#5f7f9f"];

// A colour of its own for every number: those of the palette, then hues a golden angle apart.
const colorAt = (i) => PALETTE[i] ?? `hsl(${Math.round((i * 137.508) % 360)}, 45%, ${i % 2 === 0 ? 42 : 62}%)`;

// Draws all charts of the page; again where light turns to dark.
let charts = [];
function keepDrawing(draw) {
  const redraw = () => {
    for (const chart of charts) chart.destroy();
    charts = [];
    draw();
  };
  redraw();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
byId("chart-version").textContent = `Chart.js ${Chart.version}`;
