// The program: upload, text with the active line, start, hold, and how it runs.

import { hear, order, send, write, backlog } from "./link.js";
import { STATE, counts, isState, value } from "./state.js";
import { $, make, say, setText, told } from "./dom.js";

const LINE_PX = 20;
const PIECE = 32768;
const OVERRIDES = [["FEED_OVERRIDE", "Feed", 0, 120], ["RAPID_OVERRIDE", "Rapid", 0, 100], ["SPINDLE_OVERRIDE", "Spindle", 50, 150]];
const SWITCHES = [["single", "SINGLE_BLOCK"], ["optional", "OPTIONAL_STOP"], ["delete", "BLOCK_DELETE"]];
const FRAMES_AFTER = 2; // one may have been on its way when the order was answered

let lines = [];
let shown = [0, -1], active = -1, known = "";
const waits = new Map(); // frames that a switch still shows what was wished, not what is

const table = Uint32Array.from({ length: 256 }, (_, n) => { for (let k = 0; k < 8; k += 1) n = n & 1 ? n >>> 1 ^ 0xEDB88320 : n >>> 1; return n; });
function crc32(bytes) {
  let crc = 0xFFFFFFFF;
  for (const byte of bytes) crc = table[(crc ^ byte) & 255] ^ crc >>> 8;
  return (crc ^ 0xFFFFFFFF) >>> 0;
}

const pause = (ms) => new Promise((done) => { setTimeout(done, ms); });

async function sendPieces(bytes) {
  for (let at = 0; at < bytes.length; at += PIECE) {
    send(bytes.subarray(at, at + PIECE));
    $("progress").value = at / bytes.length;
    while (backlog() > 8 * PIECE) await pause(5);
  }
}

export async function upload(file) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  $("progress").hidden = false;
  const refused = await told(order({ upload: [bytes.length, crc32(bytes)] }), file.name);
  if (!refused) {
    await sendPieces(bytes);
    if (!await told(order({ commit: 1 }), file.name)) {
      setText($("programname"), file.name);
      say(`${file.name} is loaded`, true);
    }
  }
  $("progress").hidden = true;
}

function fillLine(element, i) {
  element.style.top = `${i * LINE_PX}px`;
  element.dataset.n = i + 1;
  element.textContent = lines[i];
  element.className = `line${i + 1 === active ? " active" : ""}${i + 1 === counts("START_LINE") ? " from" : ""}`;
}

// Only the lines in sight are elements: a program may have a million.
function showText(force) {
  const box = $("text"), first = Math.max(0, Math.floor(box.scrollTop / LINE_PX) - 5);
  const last = Math.min(lines.length - 1, Math.ceil((box.scrollTop + box.clientHeight) / LINE_PX) + 5);
  if (!force && shown[0] === first && shown[1] === last) return;
  shown = [first, last];
  const space = make("div");
  space.style.height = `${lines.length * LINE_PX}px`;
  box.replaceChildren(space);
  for (let i = first; i <= last; i += 1) fillLine(box.appendChild(make("div")), i);
}

async function loadText() {
  lines = (await (await fetch("/program")).text()).split(/\r?\n/);
  if (lines[lines.length - 1] === "") lines.pop();
  showText(true);
}

function follow(line) {
  if (line === active) return;
  active = line;
  const box = $("text"), top = (line - 1) * LINE_PX;
  if (line && (top < box.scrollTop || top > box.scrollTop + box.clientHeight - 3 * LINE_PX)) box.scrollTop = top - box.clientHeight / 3;
  showText(true);
}

async function startProgram() {
  const line = Number($("fromline").value) || 0;
  if (isState(STATE.HELD)) return told(write(["CYCLE_START", 1]), "Start");
  const pairs = [["MODE", 0], ...(line > 0 ? [["START_LINE", line]] : []), ["CYCLE_START", 1]];
  return told(write(...pairs), "Start");
}

function buildOverrides() {
  for (const [name, title, least, most] of OVERRIDES) {
    const slider = make("input", { type: "range", min: least, max: most, step: 1, value: 100, id: name });
    const send1 = (percent) => told(write([name, Math.round(percent * 10)]), `${title} override`);
    slider.addEventListener("input", () => send1(slider.value));
    slider.addEventListener("change", () => slider.blur());
    $("overrides").append(make("label", { htmlFor: name, textContent: title }), slider, make("output", { id: `${name}_out` }),
      make("button", { textContent: "100", ariaLabel: `${title} override 100 %`, onclick: () => send1(100) }));
  }
}

function showOverrides() {
  for (const [name] of OVERRIDES) {
    if (document.activeElement !== $(name)) $(name).value = value(name);
    setText($(`${name}_out`), `${value(name).toFixed(0)} %`);
  }
}

function show() {
  const key = `${counts("PROGRAM_SIZE")} ${counts("PROGRAM_CRC")}`;
  if (key !== known) {
    known = key;
    loadText();
  }
  follow(isState(STATE.RUNNING, STATE.HELD, STATE.STOPPING) ? counts("ACTIVE_LINE") : 0);
  $("start").disabled = !isState(STATE.IDLE, STATE.HELD) || (!counts("PROGRAM_SIZE") && isState(STATE.IDLE));
  $("hold").disabled = !isState(STATE.RUNNING, STATE.MDI, STATE.JOGGING, STATE.HOMING);
  $("resume").disabled = !isState(STATE.HELD);
  showSwitches();
  showOverrides();
}

async function turn(id, name) {
  waits.set(id, Infinity);
  waits.set(id, await told(write([name, $(id).checked ? 1 : 0]), name) ? 0 : FRAMES_AFTER);
}

function showSwitches() {
  for (const [id, name] of SWITCHES) {
    const left = waits.get(id) || 0;
    if (left > 0) waits.set(id, left - 1);
    else $(id).checked = counts(name) !== 0;
  }
}

function listenToFiles() {
  $("file").addEventListener("change", () => { if ($("file").files[0]) upload($("file").files[0]); $("file").value = ""; });
  addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("dropping"); });
  addEventListener("dragleave", () => document.body.classList.remove("dropping"));
  addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    if (event.dataTransfer.files[0]) upload(event.dataTransfer.files[0]);
  });
}

export function startProgramPane() {
  buildOverrides();
  listenToFiles();
  $("start").onclick = startProgram;
  $("hold").onclick = () => told(write(["FEED_HOLD", 1]), "Hold");
  $("resume").onclick = () => told(write(["RESUME", 1]), "Resume");
  $("reset").onclick = () => told(write(["RESET", 1]), "Reset");
  for (const [id, name] of SWITCHES) $(id).onchange = () => turn(id, name);
  $("text").addEventListener("scroll", () => showText(false));
  $("text").addEventListener("click", (event) => { if (event.target.dataset.n) $("fromline").value = event.target.dataset.n; });
  new ResizeObserver(() => showText(true)).observe($("text"));
  hear("draw", show);
  hear("lost", () => { known = ""; });
}
