// The bus, the drives with their object dictionaries, and faults to order.

import { hear, order, send, write } from "./link.js";
import { counts, machine, value } from "./state.js";
import { $, make, setText, told } from "./dom.js";

// CiA 402: the bits of the statusword that tell the state.
const DRIVE_STATES = [[0x4F, 0x00, "not ready"], [0x4F, 0x40, "switch on disabled"], [0x6F, 0x21, "ready to switch on"], [0x6F, 0x23, "switched on"],
  [0x6F, 0x27, "operation enabled"], [0x6F, 0x07, "quick stop"], [0x4F, 0x0F, "fault reaction"], [0x4F, 0x08, "fault"]];
const SIGNED = { 2: 8, 3: 16, 4: 32 };
const ACCESS = ["read", "read, write", "write", "constant"];
const FAULTS = [["Overheats", "emcy code=4310"], ["Warns", "warn code=4310"], ["Falls silent for 1 s", "hang for=1s"], ["Heartbeat lost", "mute what=heartbeat for=1s"], ["Reboots", "reboot"], ["Jams for 1 s", "jam for=1s"],
  ["Half its torque for 5 s", "weak ratio=0.5 for=5s"], ["Encoder jumps 0.05 mm", "encoder_jump by_mm=0.05"], ["Cable cut for 1 s", "CUT"]];
const BUS_FAULTS = [["1 % of frames corrupted for 5 s", "bus corrupt ratio=0.01 for=5s"], ["One frame in a hundred lost for 5 s", "bus drop ratio=0.01 for=5s"], ["Frames 100 µs late for 5 s", "bus delay by=100us for=5s"]];

let rows = [], drive = -1, numbers = [];

const state = (word) => (DRIVE_STATES.find(([mask, bits]) => (word & mask) === bits) || ["", "", "?"])[2];
const hex = (number, digits) => number.toString(16).toUpperCase().padStart(digits, "0");

function nameOf(id) {
  const node = id & 0x7F, what = { 0x080: node ? "EMCY" : "SYNC", 0x180: "TPDO1", 0x280: "TPDO2", 0x380: "TPDO3", 0x480: "TPDO4", 0x200: "RPDO1", 0x300: "RPDO2", 0x400: "RPDO3", 0x500: "RPDO4", 0x580: "SDO answer", 0x600: "SDO request", 0x700: "heartbeat", 0x000: "NMT", 0x100: "TIME" }[id & 0x780];
  return node ? `${what} of node ${node}` : what;
}

function showBus({ bus }) {
  const cycle = machine.hello.cycle_us;
  const facts = [["Load", `${bus.load.toFixed(1)} % of ${machine.hello.bitrate / 1000} kbit/s`], ["Frames", bus.frames], ["Error frames", bus.errors], ["Lost frames", bus.dropped], ["Refused for want of room", bus.refused],
    ["Control cycle", `${value("CYCLE_MEAN").toFixed(1)} µs mean, ${value("CYCLE_MAX").toFixed(1)} µs longest, of ${cycle} µs`], ["Late cycles", counts("OVERRUNS")]];
  const longest = Math.max(...bus.responses.map((r) => r[1]), cycle);
  const bars = bus.responses.map(([id, us]) => make("tr", {}, make("td", { textContent: hex(id, 3), className: "mono" }), make("td", { textContent: nameOf(id) }),
    make("td", { textContent: `${us.toFixed(0)} µs` }), make("td", {}, make("meter", { min: 0, max: longest, value: us, high: cycle, ariaLabel: `${us} µs` }))));
  $("bus").replaceChildren(make("table", {}, ...facts.map(([name, text]) => make("tr", {}, make("td", { textContent: name }), make("td", { textContent: text })))),
    make("h3", { textContent: "Longest response times" }), make("div", { className: "scroll" }, make("table", {}, ...bars)));
  $("inforce").replaceChildren(...bus.faults.map(([kind, node, on], i) => make("li", { textContent: `${i + 1}: ${kind}${node < 128 ? ` node ${node}` : ""}${on ? "" : " (over)"}` })));
}

function describe(raw, type) {
  if (raw === null || raw === undefined) return "";
  const bits = SIGNED[type];
  const number = bits && raw >= 2 ** (bits - 1) ? raw - 2 ** bits : raw;
  return `${number}`;
}

function watch(number) {
  drive = number;
  rows = [];
  send({ watch: number });
}

async function change(row, text) {
  const number = /^0x/i.test(text) ? parseInt(text, 16) : Number(text);
  await told(order({ set: [drive, row[0], row[1], number] }), `${hex(row[0], 4)}:${hex(row[1], 2)}`);
}

function objectRow(row) {
  const field = make("td", { className: "mono" });
  const element = make("tr", {}, make("td", { className: "mono", textContent: `${hex(row[0], 4)}:${hex(row[1], 2)}` }), make("td", { textContent: row[4] }), make("td", { className: "note", textContent: ACCESS[row[3]] }), field);
  if (row[3] === 1 && row[2] < 8) {
    field.append(make("input", { className: "mono", ariaLabel: row[4] }));
    field.firstChild.addEventListener("change", (event) => { change(row, event.target.value); event.target.blur(); });
  }
  return [element, field];
}

function showObjects(message) {
  if (message.objects !== drive) return;
  rows = message.rows;
  const made = rows.map(objectRow);
  numbers = made.map(([, field]) => field);
  $("objects").replaceChildren(make("table", {}, make("tbody", {}, ...made.map(([element]) => element))));
  filter();
}

function filter() {
  const wanted = $("objectfilter").value.toLowerCase();
  [...$("objects").querySelectorAll("tr")].forEach((row) => { row.hidden = !row.textContent.toLowerCase().includes(wanted); });
}

function showValues(message) {
  if (message.values !== drive || !rows.length) return;
  message.v.forEach((raw, i) => {
    const text = describe(raw, rows[i][2]), input = numbers[i].firstElementChild;
    if (!input) setText(numbers[i], text);
    else if (input !== document.activeElement && input.value !== text) input.value = text;
  });
}

function buildDrives() {
  const { drives } = machine.hello;
  const select = make("select", { id: "driveselect", ariaLabel: "drive" }, make("option", { value: -1, textContent: "no drive" }), ...drives.map(([name, node], i) => make("option", { value: i, textContent: `${name} (node ${node})` })));
  select.onchange = () => watch(Number(select.value));
  const search = make("input", { id: "objectfilter", placeholder: "filter: 6064, velocity …", ariaLabel: "filter", oninput: filter });
  $("drives").replaceChildren(make("div", { className: "cards", id: "drivestates" }), make("h3", { textContent: "Object dictionary" }),
    drives.length ? make("div", { className: "row" }, select, search) : make("p", { className: "note", textContent: "The drives are not virtual ones of this process." }), make("div", { id: "objects", className: "scroll" }));
}

function showStates() {
  if ($("pane-drives").hidden) return;
  $("drivestates").replaceChildren(...machine.axes.map((axis) => {
    const word = counts(`DRIVE_STATUS_${axis.letter}`);
    return make("div", { className: "card" }, make("b", { textContent: axis.letter }), ` ${state(word)} `, make("span", { className: "mono note", textContent: hex(word & 0xFFFF, 4) }));
  }));
}

const give = (text) => told(order({ fault: text }), text);

function faultButtons(name, node) {
  return make("div", { className: "card" }, make("h3", { textContent: name }), ...FAULTS.map(([title, words]) => make("div", { className: "row" },
    make("button", { textContent: title, onclick: () => give(words === "CUT" ? `bus cut node=${node} for=1s` : `drive ${node} ${words}`) }))));
}

function buildFaults() {
  const { drives } = machine.hello;
  if (!drives.length) {
    $("faults").replaceChildren(make("p", { className: "note", textContent: "Faults can be ordered of virtual drives alone." }), make("ul", { id: "inforce" }));
    return;
  }
  const line = make("input", { id: "faultline", className: "grow mono", value: `drive ${drives[0][1]} emcy code=4310`, ariaLabel: "fault" });
  const form = make("form", { className: "row" }, line, make("button", { textContent: "Let it happen" }));
  form.addEventListener("submit", (event) => { event.preventDefault(); give(line.value); });
  $("faults").replaceChildren(make("p", { className: "note", textContent: "What goes wrong now. All of it: takt help inject." }), form,
    make("div", { className: "row" }, make("button", { id: "faultsend", textContent: "End what lasts", onclick: () => told(order({ clear: 1 }), "faults") }), make("button", { textContent: "Reset", onclick: () => told(write(["RESET", 1]), "Reset") })),
    make("ul", { id: "inforce", className: "mono" }),
    make("div", { className: "cards" }, ...drives.map(([name, node]) => faultButtons(name, node)), make("div", { className: "card" }, make("h3", { textContent: "The bus" }), ...BUS_FAULTS.map(([title, words]) => make("div", { className: "row" }, make("button", { textContent: title, onclick: () => give(words) }))))));
}

export function startBus() {
  hear("hello", () => { buildDrives(); buildFaults(); });
  hear("bus", showBus);
  hear("objects", showObjects);
  hear("values", showValues);
  hear("draw", showStates);
}

// The dictionary is read as long as it is looked at.
export function lookAtDrives(on) {
  if (!on && drive >= 0) send({ watch: -1 });
  if (on && machine.hello && machine.hello.drives.length) {
    $("driveselect").value = Math.max(drive, 0);
    watch(Math.max(drive, 0));
  }
}
