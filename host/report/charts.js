"use strict";
/* Charts over time: one time window and one cursor for all of them. */

const timeEnd_s = Math.max(1, runData.cycles - 1) * runData.cycle_s;
const timeMargin = { l: 76, r: 18, t: 8, b: 40 };
/* Below this share of its limit a curve would be flat beside the limit line: the line is then left out. */
const limitShareShown = 0.2;

const timeView = { start_s: 0, end_s: timeEnd_s, cursor_s: null, printing: false, hidden: new Set(), charts: [], listeners: [] };

function decodeColumn(text, Type) {
  const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  return new Type(bytes.buffer);
}

/* Curve of one series; scale: to the unit shown. */
function makeCurve(series, name, colour, scale) {
  const cycle = decodeColumn(series.cycle, Uint32Array);
  const value = decodeColumn(series.value, Float32Array);
  const curve = { name, colour, time_s: new Float64Array(cycle.length), value: new Float64Array(cycle.length) };
  for (let i = 0; i < cycle.length; i++) {
    curve.time_s[i] = cycle[i] * runData.cycle_s;
    curve.value[i] = value[i] * scale;
  }
  return curve;
}

function findExtremes(curve) {
  let [low, high] = [0, 0];
  curve.value.forEach((value, i) => {
    if (value < curve.value[low]) low = i;
    if (value > curve.value[high]) high = i;
  });
  return [low, high];
}

function axisColour(name) {
  return `--axis-${name.toLowerCase()}`;
}

/* ---- which charts there are ---- */

function feedChart() {
  const rotary = runData.axes.some((axis) => axis.rotary) ? " (°/min while rotary axes move alone)" : "";
  return { id: "feed", title: "Path feed", unit: "mm/min", note: rotary, curves: [makeCurve(runData.feed, "feed", "--feed", 1)], limits: [] };
}

/* Override and limiter, if either ever differed from 100 %. */
function overrideChart() {
  const curves = [makeCurve(runData.override, "override", "--feed", 1), makeCurve(runData.limiter, "axis limiter", "--axis-x", 1)];
  const acted = curves.filter((curve) => curve.value.some((value) => value !== 100));
  return { id: "override", title: "Feed override and axis limiter", unit: "%", note: "", curves: acted, limits: [], shape: "hv",
    lowest: true };
}

function followingScale(axes) {
  const curves = axes.map((axis) => makeCurve(axis.following, "", "", 1));
  const peak = Math.max(0, ...curves.map((curve) => Math.max(...findExtremes(curve).map((i) => Math.abs(curve.value[i] || 0)))));
  return peak < 1 ? [1000, "µm"] : [1, "mm"];
}

function followingLimit(axis) {
  const check = findCheck(`following.${axis.name}`);
  return check && check.limit;
}

/* One quantity of all linear or all rotary axes. */
function axesChart(quantity, title, axes) {
  const rotary = axes[0].rotary;
  let [scale, unit] = [1, axisUnits(axes[0])[quantity]];
  if (quantity === "following" && !rotary) [scale, unit] = followingScale(axes);
  const limits = axes.map((axis) => {
    const value = quantity === "following" ? followingLimit(axis) : axis.limit[quantity];
    return { name: axis.name, colour: axisColour(axis.name), value: value * scale };
  });
  return {
    id: `${quantity}-${rotary ? "rotary" : "linear"}`,
    title: runData.axes.some((axis) => axis.rotary !== rotary) ? `${title}, ${rotary ? "rotary" : "linear"} axes` : title,
    unit, note: "",
    curves: axes.map((axis) => makeCurve(axis[quantity], axis.name, axisColour(axis.name), scale)),
    limits: limits.filter((limit) => limit.value > 0),
  };
}

function listCharts() {
  const groups = [false, true].map((rotary) => runData.axes.filter((axis) => axis.rotary === rotary));
  const quantities = [["velocity", "Axis velocity"], ["acceleration", "Axis acceleration"], ["jerk", "Axis jerk"],
    ["following", "Following error"]];
  const ofAxes = quantities.flatMap(([quantity, title]) =>
    groups.filter((axes) => axes.length > 0).map((axes) => axesChart(quantity, title, axes)));
  return [feedChart(), overrideChart(), ...ofAxes].filter((chart) => chart.curves.length > 0);
}

/* ---- what a chart says in words ---- */

function describePeak(chart, curve) {
  const [low, high] = findExtremes(curve);
  if (curve.value.length === 0) return "no values";
  const at = chart.lowest || Math.abs(curve.value[low]) > Math.abs(curve.value[high]) ? low : high;
  const limit = chart.limits.find((candidate) => candidate.name === curve.name);
  const share = limit ? `, ${formatNumber((100 * Math.abs(curve.value[at])) / limit.value, 3)} % of its limit` : "";
  return `${formatNumber(curve.value[at], 4)} ${chart.unit}${share}, at ${formatNumber(curve.time_s[at], 5)} s, line ${findOnPath(curve.time_s[at]).line}`;
}

function describeChart(chart) {
  const items = chart.curves.map((curve) => element("li", {},
    element("span", { class: "swatch", style: `background:var(${curve.colour})` }),
    element("b", {}, curve.name), ` ${chart.lowest ? "lowest" : "peak"} ${describePeak(chart, curve)}`));
  return element("ul", { class: "peaks" }, ...items);
}

/* ---- drawing ---- */

function cssColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function limitsShown(chart) {
  const always = document.getElementById("limits-always").checked;
  return chart.limits.filter((limit) => {
    const curve = chart.curves.find((candidate) => candidate.name === limit.name);
    const [low, high] = findExtremes(curve).map((i) => Math.abs(curve.value[i] || 0));
    return !timeView.hidden.has(limit.name) && (always || Math.max(low, high) >= limitShareShown * limit.value);
  });
}

/* Height of a chart: its visible curves and limits, with a little air. */
function chartRange(chart, limits) {
  const values = chart.curves.filter((curve) => !timeView.hidden.has(curve.name))
    .flatMap((curve) => findExtremes(curve).map((i) => curve.value[i] || 0));
  for (const limit of limits) values.push(limit.value, -limit.value);
  const [low, high] = [Math.min(0, ...values), Math.max(0, ...values)];
  const air = (high - low) * 0.07 || 1;
  return [low < 0 ? low - air : 0, high + air];
}

/* Axes with the same limit share one line and one label. */
function limitLines(limits) {
  const values = [...new Set(limits.map((limit) => limit.value))];
  return values.map((value) => {
    const owners = limits.filter((limit) => limit.value === value);
    const colour = cssColour(owners.length === 1 ? owners[0].colour : "--limit");
    return { value, colour, label: `limit ${owners.map((limit) => limit.name).join(" ")} ±${formatNumber(value, 5)}` };
  });
}

function limitShapes(lines) {
  return lines.flatMap(({ value, colour }) => [value, -value].map((y) => ({
    type: "line", xref: "paper", x0: 0, x1: 1, y0: y, y1: y, line: { color: colour, width: 1.5, dash: "dash" } })));
}

function limitLabels(lines) {
  return lines.map(({ value, colour, label }) => ({
    text: label, xref: "paper", x: 0, y: value, xanchor: "left", yanchor: "bottom", showarrow: false, font: { size: 12, color: colour },
    bgcolor: cssColour("--card"), opacity: 0.9, borderpad: 1 }));
}

function chartLayout(chart) {
  const limits = limitsShown(chart);
  const lines = limitLines(limits);
  const [text, grid, line] = ["--soft", "--grid", "--line"].map(cssColour);
  const axis = { gridcolor: grid, zerolinecolor: line, linecolor: line, tickcolor: line, zeroline: true };
  return {
    ...printSize({ width: 650, height: 205 }), margin: timeMargin, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", showlegend: false,
    font: { family: getComputedStyle(document.body).fontFamily, size: 13, color: text },
    hovermode: "x unified", hoverlabel: { bgcolor: cssColour("--card"), bordercolor: line, font: { color: cssColour("--text") } },
    dragmode: "zoom", modebar: modebarColours(),
    xaxis: { ...axis, title: { text: "time in s", standoff: 6 }, range: [timeView.start_s, timeView.end_s], hoverformat: ".4f",
      unifiedhovertitle: { text: "%{x} s" } },
    yaxis: { ...axis, title: { text: chart.unit, standoff: 4 }, range: chartRange(chart, limits), exponentformat: "none",
      separatethousands: true, nticks: 7 },
    shapes: limitShapes(lines), annotations: limitLabels(lines),
  };
}

function chartTraces(chart) {
  return chart.curves.map((curve) => ({
    type: "scatter", mode: "lines", name: curve.name, x: curve.time_s, y: curve.value,
    line: { color: cssColour(curve.colour), width: 1.4, shape: chart.shape || "linear" },
    visible: !timeView.hidden.has(curve.name), hovertemplate: `%{y:,.5~g} ${chart.unit}`,
  }));
}

/* On paper a plot has the width of a page; on the screen it follows its frame. */
function printSize(size) {
  return timeView.printing ? { ...size, autosize: false } : { autosize: true };
}

function modebarColours() {
  return { bgcolor: "rgba(0,0,0,0)", color: cssColour("--rapid"), activecolor: cssColour("--accent") };
}

function plotConfig(name) {
  return { displaylogo: false, responsive: true, modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"],
    toImageButtonOptions: { filename: `${fileName(runSummary.program || "run")}-${name}`, scale: 2 } };
}

async function drawChart(chart) {
  const figure = element("figure", { class: "card" },
    element("h3", {}, `${chart.title} `, element("small", {}, `in ${chart.unit}${chart.note}`)));
  chart.plot = element("div", { class: "plot", id: `chart-${chart.id}`, tabindex: "0" });
  chart.cursor = element("div", { class: "cursor" });
  const words = describeChart(chart);
  chart.plot.setAttribute("aria-label", `${chart.title} over time. ${words.textContent}`);
  figure.append(chart.plot, element("figcaption", {}, words));
  document.getElementById("chart-list").append(figure);
  await Plotly.newPlot(chart.plot, chartTraces(chart), chartLayout(chart), plotConfig(chart.id));
  chart.plot.append(chart.cursor);
  chart.plot.dataset.points = chart.plot.data.map((trace) => `${trace.name}:${trace.x.length}`).join(" ");
  chart.plot.on("plotly_relayout", (change) => followZoom(chart, change));
  chart.plot.addEventListener("pointermove", (event) => pointAt(chart, event));
}

function redrawCharts() {
  return Promise.all(timeView.charts.map((chart) =>
    Plotly.react(chart.plot, chartTraces(chart), chartLayout(chart), plotConfig(chart.id))));
}

/* ---- one time window ---- */

function followZoom(chart, change) {
  if (change["xaxis.autorange"]) setWindow(0, timeEnd_s);
  else if ("xaxis.range[0]" in change) setWindow(change["xaxis.range[0]"], change["xaxis.range[1]"]);
  else if (change["xaxis.range"]) setWindow(...change["xaxis.range"]);
}

function setWindow(start_s, end_s) {
  if (start_s === timeView.start_s && end_s === timeView.end_s) return;
  timeView.start_s = start_s;
  timeView.end_s = end_s;
  for (const chart of timeView.charts) {
    const shown = chart.plot.layout.xaxis.range;
    if (shown[0] !== start_s || shown[1] !== end_s) Plotly.relayout(chart.plot, { "xaxis.range": [start_s, end_s] });
  }
  showCursor();
}

/* Keeps the middle where it is, or under the cursor when that is visible, and stays within the run. */
function zoomWindow(factor) {
  const width = Math.min(timeEnd_s, (timeView.end_s - timeView.start_s) * factor);
  const t = timeView.cursor_s;
  const pivot = t !== null && t > timeView.start_s && t < timeView.end_s ? t : (timeView.start_s + timeView.end_s) / 2;
  const share = (pivot - timeView.start_s) / (timeView.end_s - timeView.start_s);
  const start = Math.min(Math.max(0, pivot - share * width), timeEnd_s - width);
  setWindow(start, start + width);
}

function moveWindow(share) {
  const width = timeView.end_s - timeView.start_s;
  const start = Math.min(Math.max(0, timeView.start_s + share * width), Math.max(0, timeEnd_s - width));
  setWindow(start, start + width);
}

const windowActions = {
  in: () => zoomWindow(0.5), out: () => zoomWindow(2), back: () => moveWindow(-0.25), on: () => moveWindow(0.25),
  all: () => setWindow(0, timeEnd_s),
};

/* ---- one cursor ---- */

function pointAt(chart, event) {
  const box = chart.plot.getBoundingClientRect();
  const share = (event.clientX - box.left - timeMargin.l) / (box.width - timeMargin.l - timeMargin.r);
  if (share >= 0 && share <= 1) setCursor(timeView.start_s + share * (timeView.end_s - timeView.start_s));
}

function setCursor(time_s) {
  timeView.cursor_s = Math.min(Math.max(0, time_s), timeEnd_s);
  showCursor();
  for (const listener of timeView.listeners) listener(timeView.cursor_s);
}

function showCursor() {
  const share = (timeView.cursor_s - timeView.start_s) / (timeView.end_s - timeView.start_s);
  const visible = timeView.cursor_s !== null && share >= 0 && share <= 1;
  for (const { plot, cursor } of timeView.charts) {
    const x = timeMargin.l + share * (plot.clientWidth - timeMargin.l - timeMargin.r);
    cursor.style.visibility = visible ? "visible" : "hidden";
    cursor.style.transform = `translateX(${x}px)`;
  }
}

function stepCursor(share) {
  const width = timeView.end_s - timeView.start_s;
  const from = timeView.cursor_s === null ? (timeView.start_s + timeView.end_s) / 2 : timeView.cursor_s;
  setCursor(from + share * width);
}

const keyActions = {
  "+": windowActions.in, "=": windowActions.in, "-": windowActions.out, "0": windowActions.all,
  ArrowLeft: (event) => event.shiftKey ? windowActions.back() : stepCursor(-0.005),
  ArrowRight: (event) => event.shiftKey ? windowActions.on() : stepCursor(0.005),
};

/* ---- switches ---- */

function addAxisSwitches() {
  const switches = document.getElementById("axis-switches");
  for (const axis of runData.axes) {
    const swatch = element("span", { class: "swatch", style: `background:var(${axisColour(axis.name)})` });
    const button = element("button", { type: "button", "aria-pressed": "true" }, swatch, axis.name);
    button.addEventListener("click", () => {
      const shown = timeView.hidden.delete(axis.name) || !timeView.hidden.add(axis.name);
      button.setAttribute("aria-pressed", String(shown));
      redrawCharts();
    });
    switches.append(button);
  }
}

function listenForTime() {
  for (const button of document.querySelectorAll("[data-time]"))
    button.addEventListener("click", windowActions[button.dataset.time]);
  document.getElementById("limits-always").addEventListener("change", redrawCharts);
  document.getElementById("chart-list").addEventListener("keydown", (event) => {
    if (!(event.key in keyActions) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keyActions[event.key](event);
  });
}

async function showCharts() {
  addAxisSwitches();
  listenForTime();
  timeView.charts = listCharts();
  for (const chart of timeView.charts) await drawChart(chart);
}
