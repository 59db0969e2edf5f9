"use strict";
/* Numbers and words, and the tables made of the run's summary. */

listenForErrors();

const runSummary = parseJson("run-summary");
const runData = parseJson("run-data");

function parseJson(id) {
  return JSON.parse(document.getElementById(id).textContent);
}

/* Whatever goes wrong is said on the page, not only in the browser's console. */
function listenForErrors() {
  const say = (text) => {
    document.documentElement.dataset.errors = (document.documentElement.dataset.errors || "") + text + "\n";
    document.getElementById("problems").append(element("p", { class: "note warn" }, `This page has a problem: ${text}`));
  };
  addEventListener("error", (event) => say(event.message));
  addEventListener("unhandledrejection", (event) => say(String(event.reason)));
  document.addEventListener("securitypolicyviolation", (event) => say(`${event.violatedDirective} ${event.blockedURI}`));
}

/* element("td", { class: "code" }, "text", otherElement, ...) */
function element(tag, attributes, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) made.setAttribute(name, value);
  made.append(...children.filter((child) => child !== null));
  return made;
}

function formatNumber(value, digits = 5) {
  const size = Math.abs(value);
  if (size > 0 && (size < 1e-6 || size >= 1e12)) return Number(value.toPrecision(3)).toExponential().replaceAll("-", "−");
  const whole = size >= 1 ? Math.floor(Math.log10(size)) + 1 : 0;
  return value.toLocaleString("en", { maximumSignificantDigits: Math.max(digits, whole) }).replace("-", "−");
}

/* Below what the trace resolves, the digits are rounding. */
function atLeast(value, least) {
  return value > 0 && value < least ? `< ${formatNumber(least)}` : value;
}

function formatDuration(seconds) {
  if (seconds < 60) return [formatNumber(seconds, 5), "s"];
  const whole = Math.floor(seconds / 60);
  const rest = formatNumber(seconds - 60 * whole, 3);
  if (whole < 60) return [`${whole}`, `min ${rest} s`];
  return [`${Math.floor(whole / 60)}`, `h ${whole % 60} min ${Math.floor(seconds % 60)} s`];
}

/* A field's name ends in its unit; the longest ending counts. */
const unitEndings = [
  ["_mm_s3", "mm/s³"], ["_mm_s2", "mm/s²"], ["_mm_s", "mm/s"], ["_mm_min", "mm/min"], ["_mm", "mm"],
  ["_deg_s3", "°/s³"], ["_deg_s2", "°/s²"], ["_deg_s", "°/s"], ["_deg", "°"],
  ["_percent", "%"], ["_ns", "ns"], ["_us", "µs"], ["_s", "s"],
];

/* "load_percent" -> ["load", "%"] */
function splitUnit(field) {
  const ending = unitEndings.find(([suffix]) => field.endsWith(suffix));
  return ending ? [field.slice(0, -ending[0].length), ending[1]] : [field, ""];
}

function axisUnits(axis) {
  const length = axis.rotary ? "°" : "mm";
  return { velocity: `${length}/s`, acceleration: `${length}/s²`, jerk: `${length}/s³`, following: length };
}

function fileName(path) {
  return String(path).replace(/^.*[\\/]/, "");
}

function brokenChecks() {
  return (runSummary.checks || []).filter((check) => check.held === false);
}

/* ---- headline ---- */

function showBadges() {
  const outcome = runSummary.outcome || "unknown";
  const tone = { completed: "good", faulted: "bad" }[outcome] || "warn";
  const badges = document.getElementById("badges");
  badges.append(element("span", { class: `badge ${tone}` }, outcome[0].toUpperCase() + outcome.slice(1)));
  const measured = (runSummary.checks || []).filter((check) => typeof check.held === "boolean");
  if (measured.length === 0) return;
  const broken = brokenChecks().length;
  badges.append(broken === 0
    ? element("span", { class: "badge good" }, `✓ All ${measured.length} checks held`)
    : element("span", { class: "badge bad" }, `✗ ${broken} of ${measured.length} checks broken`));
}

function showHeadline() {
  const program = fileName(runSummary.program || "Run");
  const machine = runSummary.machine ? `on ${fileName(runSummary.machine)}` : "";
  document.title = `${program} ${machine} – ${runSummary.outcome || "run report"}`;
  document.getElementById("program").textContent = program;
  document.getElementById("subtitle").textContent = `takt run report ${machine && "· " + machine}`;
  showBadges();
  const problems = document.getElementById("problems");
  if (runSummary.fault) problems.append(element("p", { class: "note bad" }, `Fault: ${describe(runSummary.fault)}`));
  for (const check of brokenChecks()) {
    const [reached, limit] = [check.value, check.limit].map((n) => typeof n === "number" ? formatNumber(n, 6) : "?");
    problems.append(element("p", { class: "note bad" }, `Check ${check.name} is broken: ${reached}, limit ${limit}`));
  }
}

function describe(value) {
  return typeof value === "object" ? Object.entries(value).map(([k, v]) => `${k} ${v}`).join(", ") : String(value);
}

/* One is the bus; of two each has the name that it has in a log. */
function busesByName() {
  const names = runSummary.can1 ? [["can0", runSummary.bus], ["can1", runSummary.can1]] : [["Bus", runSummary.bus]];
  return names.filter(([, bus]) => bus);
}

function showFigures() {
  const figures = document.getElementById("figures");
  const add = (name, value, unit) => {
    if (value === undefined || value === null) return;
    const text = typeof value === "number" ? formatNumber(value) : value;
    figures.append(element("div", {}, element("dt", {}, name), element("dd", {}, text + " ", element("small", {}, unit))));
  };
  if (typeof runSummary.program_time_s === "number") add("Program time", ...formatDuration(runSummary.program_time_s));
  add("Path length", runSummary.path_length_mm, "mm");
  add("Blocks", runSummary.blocks, "");
  add(`Cycles of ${formatNumber(runData.cycle_s * 1e3)} ms`, runSummary.cycles, "");
  add("Path error", atLeast(runSummary.path_error_max_mm, 1e-9), "mm");
  for (const [name, bus] of busesByName()) {
    add(`${name} load`, bus.load_percent, "%");
    if (runSummary.can1) add(`${name} longest response, worst case`, Math.max(0, ...bus.responses.map((r) => r.predicted_us || 0)), "us");
  }
  add("Real time ratio", runSummary.realtime_ratio, "×");
}

/* ---- tables ---- */

function bar(ratio, broken) {
  const width = `width:${Math.min(100, 100 * ratio).toFixed(1)}%`;
  const percent = formatNumber(100 * ratio, 4);
  return element("div", { class: "bar", title: `${percent} % of the limit` },
    element("i", { style: width, class: broken ? "over" : "" }));
}

/* A value beside its limit, with a bar for how much of the limit is used. check: the one that judged it, if any. */
function measured(value, unit, limit, check) {
  if (typeof value !== "number") return [element("span", { class: "unit" }, "not measured")];
  const text = [formatNumber(value, 6) + " "];
  if (typeof limit !== "number") return [...text, element("span", { class: "unit" }, unit)];
  text.push(element("span", { class: "of" }, `of ${formatNumber(limit, 6)} ${unit}`));
  if (limit > 0) text.push(bar(Math.abs(value) / limit, check && check.held === false));
  return text;
}

/* "max_velocity_mm_s" or "max_velocity_deg_s", whichever the axis has. */
function axisMaximum(axis, quantity) {
  const key = Object.keys(axis).find((field) => field.startsWith(`max_${quantity}_`));
  return key === undefined ? null : axis[key];
}

function findCheck(name) {
  return (runSummary.checks || []).find((check) => check.name === name);
}

function showAxes() {
  const rows = (runSummary.axes || []).map((axis) => {
    const machine = runData.axes.find((candidate) => candidate.name === axis.name) || { limit: {} };
    const units = axisUnits(machine);
    const cells = ["velocity", "acceleration", "jerk"].map((quantity) => element("td", {},
      ...measured(axisMaximum(axis, quantity), units[quantity], machine.limit[quantity], findCheck(`${quantity}.${axis.name}`))));
    const following = findCheck(`following.${axis.name}`);
    cells.push(element("td", {},
      ...measured(axisMaximum(axis, "following_error"), units.following, following && following.limit, following)));
    return element("tr", {}, element("th", { scope: "row" }, axis.name), ...cells);
  });
  fillTable("axes", ["Axis", "Velocity", "Acceleration", "Jerk", "Following error"], rows);
}

function showChecks() {
  const checks = runSummary.checks || [];
  document.getElementById("checks-section").hidden = checks.length === 0;
  fillTable("checks", ["Check", "Result", "Value beside limit"], checks.map((check) => {
    const [tone, word] = check.held === true ? ["good", "✓ held"] : check.held === false ? ["bad", "✗ broken"] : ["", "not measured"];
    return element("tr", {}, element("th", { scope: "row" }, check.name), element("td", { class: tone }, word),
      element("td", {}, ...measured(check.value, "", check.limit, check)));
  }));
}

function fillTable(id, heads, rows) {
  const head = element("tr", {}, ...heads.map((text) => element("th", { scope: "col" }, text)));
  document.getElementById(id).append(element("thead", {}, head), element("tbody", {}, ...rows));
}

/* Everything that is not a list; nested names are joined by a space, and the unit of the outer name holds inside. */
function summaryRows(object, outerName, outerUnit) {
  return Object.entries(object).flatMap(([field, value]) => {
    const [inner, unit] = splitUnit(field);
    const name = `${outerName} ${inner.replaceAll("_", " ")}`.trim();
    if (Array.isArray(value)) return [];
    if (value !== null && typeof value === "object") return summaryRows(value, name, unit);
    return [summaryRow(name[0].toUpperCase() + name.slice(1), value, unit || outerUnit)];
  });
}

function summaryRow(label, value, unit) {
  const row = element("tr", {}, element("th", { scope: "row" }, label));
  if (value === null) row.append(element("td", {}, element("span", { class: "unit" }, label === "Fault" ? "none" : "not measured")));
  else if (typeof value === "number") row.append(element("td", {}, formatNumber(value, 9), " ", element("span", { class: "unit" }, unit)));
  else row.append(element("td", { class: "code" }, String(value)));
  return row;
}

function showSummary() {
  showHeadline();
  showFigures();
  showAxes();
  showChecks();
  document.getElementById("summary").append(element("tbody", {}, ...summaryRows(runSummary, "", "")));
  const width = runData.width_cycles;
  document.getElementById("bucket").textContent = width === 1 ? "cycle" : `${width} cycles`;
}
