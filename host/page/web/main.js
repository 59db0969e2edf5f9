// The page: positions, gauges, tabs, and what the other modules show.

import { connect, hear, write } from "./link.js";
import { HOLDS, STATE, STATES, axisValue, counts, isState, machine, modes, value } from "./state.js";
import { $, make, say, setText, told } from "./dom.js";
import { startView } from "./view.js";
import { startProgramPane } from "./program.js";
import { startJog } from "./jog.js";
import { startTables } from "./tables.js";
import { startAxes } from "./axes.js";
import { lookAtDrives, startBus } from "./bus.js";

const KIND = { [STATE.RUNNING]: "go", [STATE.MDI]: "go", [STATE.JOGGING]: "go", [STATE.HOMING]: "go", [STATE.HELD]: "hold", [STATE.STOPPING]: "hold", [STATE.ALARM]: "stop", [STATE.EMERGENCY]: "stop" };
const DIGITS = 3;

let gauges = {};

// What a test measures: from the cycle that a frame shows to its drawing.
const glass = { ages: [] };
window.takt = { glass, machine, counts, value };

function buildPositions() {
  setText($("machine"), machine.hello.machine);
  $("dro").replaceChildren(...machine.axes.map((axis) => make("tr", {}, make("td", { textContent: axis.letter }), make("td"), make("td"), make("td"))));
}

function showPositions() {
  const homed = counts("HOMED");
  machine.axes.forEach((axis, row) => {
    const cells = $("dro").rows[row].cells;
    cells[0].className = homed >> axis.i & 1 ? "" : "unhomed";
    cells[0].title = homed >> axis.i & 1 ? "" : "not homed";
    ["WORK_POSITION", "POSITION", "DISTANCE_TO_GO"].forEach((name, i) => setText(cells[i + 1], axisValue(name, axis).toFixed(DIGITS)));
  });
  setText($("modes"), `${modes()} · T${counts("TOOL")}${counts("COOLANT") & 1 ? " M7" : ""}${counts("COOLANT") & 2 ? " M8" : ""}`);
}

function buildGauges() {
  gauges = {};
  for (const name of ["Feed", "Override", "Spindle rpm", "Spindle load", "Bus load", "Control cycle"]) {
    gauges[name] = make("b");
    $("gauges").append(make("div", { className: "gauge" }, make("span", { className: "note", textContent: name }), make("br"), gauges[name], make("i")));
  }
}

function gauge(name, text, part) {
  setText(gauges[name], text);
  gauges[name].parentElement.style.setProperty("--part", `${Math.min(100, Math.max(0, part))}%`);
}

// Why the override is not the one that is set; where it is, there is nothing to tell.
function overrideNote() {
  if (value("OVERRIDE_EFFECTIVE") === value("FEED_OVERRIDE")) return "";
  return ["", " held", " locked", " limited"][counts("OVERRIDE_REASON")];
}

function showGauges() {
  const most = Math.max(...machine.axes.filter((a) => !a.rotary).map((a) => a.limits[0])) * 60;
  gauge("Feed", `${value("FEED").toFixed(0)} mm/min`, 100 * value("FEED") / most);
  gauge("Override", `${value("OVERRIDE_EFFECTIVE").toFixed(0)} %${overrideNote()}`, value("OVERRIDE_EFFECTIVE") / 1.2);
  gauge("Spindle rpm", `${value("SPINDLE_SPEED").toFixed(0)} of ${value("SPINDLE_COMMANDED").toFixed(0)}`, 100 * value("SPINDLE_SPEED") / (value("SPINDLE_COMMANDED") || 1));
  gauge("Spindle load", `${value("SPINDLE_LOAD").toFixed(0)} %`, value("SPINDLE_LOAD"));
  gauge("Control cycle", `${value("CYCLE_MEAN").toFixed(1)} µs`, 100 * value("CYCLE_MEAN") / machine.hello.cycle_us);
  gauge("Bus load", `${value("BUS_LOAD").toFixed(1)} %`, value("BUS_LOAD"));
}

function showState() {
  const state = counts("STATE");
  setText($("state"), STATES[state] + (state === STATE.HELD ? `: ${HOLDS[counts("HOLD_REASON")]}` : ""));
  $("state").dataset.kind = KIND[state] || "";
  const isOff = isState(STATE.EMERGENCY);
  setText($("estop"), isOff && counts("EMERGENCY_STOP") ? "Release stop" : "EMERGENCY STOP");
  setText($("health"), `cycle ${machine.hello.cycle_us} µs · late ${counts("OVERRUNS")} · digest ${digest()}`);
}

function digest() {
  const half = (name) => (counts(name) >>> 0).toString(16).padStart(8, "0");
  return half("DIGEST_HIGH") + half("DIGEST_LOW");
}

function measure(frame) {
  glass.ages.push(Date.now() - frame.t);
  if (glass.ages.length > 3000) glass.ages.shift();
}

function show(frame) {
  if (!machine.hello) return;
  showPositions();
  showGauges();
  showState();
  measure(frame);
}

function choose(name) {
  for (const button of $("tablist").children) {
    const on = button.dataset.pane === name;
    button.setAttribute("aria-selected", on);
    button.tabIndex = on ? 0 : -1;
    $(button.dataset.pane).hidden = !on;
  }
  lookAtDrives(name === "pane-drives");
}

function turnTabs(event) {
  const way = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
  if (!way) return;
  const all = [...$("tablist").children], next = all[(all.indexOf(event.target) + way + all.length) % all.length];
  event.stopPropagation();
  next.focus();
  choose(next.dataset.pane);
}

function buildTabs() {
  for (const pane of document.querySelectorAll("[role=tabpanel]")) {
    const button = make("button", { textContent: pane.dataset.title, role: "tab", onclick: () => choose(pane.id) });
    button.dataset.pane = pane.id;
    button.setAttribute("role", "tab");
    button.setAttribute("aria-controls", pane.id);
    $("tablist").append(button);
  }
  $("tablist").addEventListener("keydown", turnTabs);
  choose("pane-jog");
}

function stopAll() {
  const release = isState(STATE.EMERGENCY) && counts("EMERGENCY_STOP");
  told(write(["EMERGENCY_STOP", release ? 0 : 1]), "Emergency stop").then((refused) => { if (!refused && release) say("Released. Reset enables the drives.", true); });
}

function listenToKeys() {
  addEventListener("keydown", (event) => {
    if (event.ctrlKey && event.code === "Space") { event.preventDefault(); if (!isState(STATE.EMERGENCY)) stopAll(); }
    if (event.key === "Escape") { event.preventDefault(); told(write(["FEED_HOLD", 1]), "Hold"); }
    if (event.ctrlKey && event.key === "Enter" && !event.repeat && !$("start").disabled) $("start").click();
  }, true);
}

hear("hello", () => { buildPositions(); });
hear("draw", show);
hear("lost", () => { setText($("state"), "no connection"); $("state").dataset.kind = "stop"; });
for (const element of document.querySelectorAll("[data-help]")) element.title = element.dataset.help;
buildGauges();
buildTabs();
listenToKeys();
startView();
startProgramPane();
startJog();
startTables();
startAxes();
startBus();
$("estop").onclick = stopAll;
connect();
