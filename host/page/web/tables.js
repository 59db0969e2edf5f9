// Work offsets and tools as tables, touch-off, and the alarms that have been.

import { hear, write } from "./link.js";
import { ALARMS, SYSTEMS, counts, machine, toCounts } from "./state.js";
import { $, make, setText, told } from "./dom.js";
import { runLine } from "./jog.js";

let tables = null, alarm = "";

const heads = (...names) => make("thead", {}, make("tr", {}, ...names.map((name) => make("th", { textContent: name }))));
const isEditing = (box) => box.contains(document.activeElement) && document.activeElement.matches("input");

function cell(number, label, store) {
  const input = make("input", { type: "number", step: "any", value: Number(number.toFixed(4)), ariaLabel: label });
  input.addEventListener("change", () => store(Number(input.value)));
  input.addEventListener("keydown", (event) => { if (event.key === "Enter") input.blur(); });
  return make("td", {}, input);
}

function setOffset(system, axis, number) {
  return told(write(["WORK_SYSTEM", system], [`WORK_OFFSET_${axis.letter}`, toCounts("WORK_OFFSET_X", number)]), `${SYSTEMS[system - 1]} ${axis.letter}`);
}

// mm or degrees as a line of a program says them with the modes that are active: G20, and diameters of G7.
function word(axis, number) {
  const modes = counts("MODES"), inches = modes & 8 && !axis.rotary ? 25.4 : 1, diameter = modes & 4096 && axis.letter === "X" ? 2 : 1;
  return axis.letter + (number * diameter / inches).toFixed(6);
}

// By a line, since only the controller knows at one moment where the axis is and what the offset was.
const touchOff = (axis, number) => runLine(`G10 L20 P${counts("SYSTEM")} ${word(axis, number)}`);

function touchRow() {
  const axis = make("select", { ariaLabel: "axis" }, ...machine.axes.map((a) => make("option", { textContent: a.letter, value: a.letter })));
  const number = make("input", { type: "number", step: "any", value: 0, ariaLabel: "work position" });
  const button = make("button", { textContent: "Touch off", onclick: () => touchOff(machine.axes.find((a) => a.letter === axis.value), Number(number.value)) });
  button.id = "touchoff";
  return make("div", { className: "row" }, "The work position of ", axis, " here is ", number, button);
}

function showOffsets() {
  const box = $("offsets");
  if (isEditing(box)) return;
  const rows = tables.systems.map((system, i) => {
    const row = make("tr", { className: counts("SYSTEM") === i + 1 ? "selected" : "" }, make("td", { textContent: SYSTEMS[i] }),
      ...machine.axes.map((axis) => cell(system[axis.i], `${SYSTEMS[i]} ${axis.letter}`, (number) => setOffset(i + 1, axis, number))));
    return row;
  });
  const table = make("table", {}, heads("", ...machine.axes.map((a) => a.letter)), make("tbody", {}, ...rows));
  box.replaceChildren(touchRow(), make("div", { className: "scroll" }, table));
}

function setTool(tool, name, number) {
  return told(write(["TOOL_SELECT", tool], [name, toCounts(name, number)]), `tool ${tool}`);
}

// The length that makes the work position of Z what is given.
const touchTool = (tool, number) => runLine(`G10 L10 P${tool} ${word(machine.axes.find((a) => a.letter === "Z"), number)}`);

function toolRow(tool) {
  const [number, ...rest] = tool;
  const touch = make("button", { textContent: "Z = 0 here", ariaLabel: `touch off tool ${number}`, onclick: () => touchTool(number, 0) });
  return make("tr", { className: counts("TOOL") === number ? "selected" : "" }, make("td", { textContent: `T${number}` }),
    cell(rest[2], `tool ${number} length`, (n) => setTool(number, "TOOL_OFFSET_Z", n)),
    cell(rest[6], `tool ${number} diameter`, (n) => setTool(number, "TOOL_DIAMETER", n)),
    cell(rest[0], `tool ${number} X`, (n) => setTool(number, "TOOL_OFFSET_X", n)), make("td", {}, touch));
}

function showTools() {
  const box = $("tools");
  if (isEditing(box)) return;
  if (!tables.tools.length) {
    box.replaceChildren(make("p", { className: "note", textContent: "There is no tool table: takt serve --tools FILE." }));
    return;
  }
  const table = make("table", {}, heads("", "Length Z", "Diameter", "X", ""), make("tbody", {}, ...tables.tools.map(toolRow)));
  box.replaceChildren(make("div", { className: "scroll" }, table));
}

function showTables() {
  if (!tables || !machine.hello) return;
  showOffsets();
  showTools();
}

function showAlarm(frame) {
  const line = counts("ALARM_LINE"), where = line && !frame.a.includes("line ") ? ` (line ${line})` : "";
  const text = counts("ALARM") ? `${ALARMS[counts("ALARM")]}: ${frame.a}${where}` : "";
  if (text === alarm) return;
  alarm = text;
  $("alarm").hidden = !text;
  setText($("alarmtext"), text);
  if (text) $("alarms").prepend(make("li", {}, make("time", { textContent: new Date().toLocaleTimeString() }), ` ${text}`));
}

export function startTables() {
  hear("tables", (message) => { tables = message.tables; showTables(); });
  hear("hello", showTables);
  hear("frame", showAlarm);
  $("acknowledge").onclick = () => told(write(counts("ALARM") === 5 ? ["EMERGENCY_STOP", 0] : ["ACKNOWLEDGE", 1]), "Acknowledge");
}
