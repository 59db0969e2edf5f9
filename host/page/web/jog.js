// Jog by pointer and key with a dead-man's handle, by steps, homing, MDI.
//
// A jog without a distance is for the page in control alone: control is claimed with a short watchdog, signs of life go out
// several times within it, and whatever ends them (a lost key, a hidden page, a cut network) ends the motion.

import { hear, send, write } from "./link.js";
import { STATE, counts, isState, machine, toCounts } from "./state.js";
import { $, make, setText, told } from "./dom.js";

const WATCHDOG_MS = 120, ALIVE_MS = 30, CLAIMED_MS = 5000, CLAIMED_ALIVE_MS = 1000;
const KEYS = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowUp: [1, 1], ArrowDown: [1, -1], PageUp: [2, 1], PageDown: [2, -1] };

let jog = null; // { axis, sign, from, timer, isMoving }
let claimed = 0;
const history = JSON.parse(localStorage.getItem("mdi") || "[]");
let place = history.length;

const coil = (sign) => (sign > 0 ? "JOG_PLUS" : "JOG_MINUS");

async function step(axis, sign, distance) {
  await told(write(["MODE", 2], ["JOG_AXIS", axis], ["JOG_FEED", Number($("jogfeed").value)], ["JOG_DISTANCE", toCounts("JOG_DISTANCE", distance)], [coil(sign), 1]), "Jog");
}

async function move(mine) {
  const refused = await told(write(["WATCHDOG", WATCHDOG_MS], ["MODE", 2], ["JOG_AXIS", mine.axis], ["JOG_FEED", Number($("jogfeed").value)], ["JOG_DISTANCE", 0], [coil(mine.sign), 1]), "Jog");
  if (refused) return release(mine);
  if (jog !== mine) return stop(mine);
  return undefined;
}

// The control that was there before is there again.
function release(mine) {
  clearInterval(mine.timer);
  if (jog === mine) jog = null;
  if (counts("CONTROL") !== 2) write(["WATCHDOG", claimed ? CLAIMED_MS : 0]);
}

async function stop(mine) {
  await told(write([coil(mine.sign), 0]), "Jog");
  release(mine);
}

function press(axis, sign, from) {
  if (jog) return;
  const distance = Number($("jogstep").value);
  if (distance > 0) { step(axis, sign, distance); return; }
  jog = { axis, sign, from };
  jog.timer = setInterval(() => send({ alive: 1 }), ALIVE_MS);
  move(jog);
}

function letGo(from) {
  if (!jog || (from !== undefined && jog.from !== from)) return;
  const mine = jog;
  jog = null;
  clearInterval(mine.timer);
  stop(mine);
}

function jogButton(axis, sign) {
  const button = make("button", { textContent: `${axis.letter}${sign > 0 ? "+" : "−"}`, ariaLabel: `jog ${axis.letter} ${sign > 0 ? "up" : "down"}` });
  button.dataset.jog = `${axis.letter}${sign > 0 ? "+" : "-"}`;
  button.addEventListener("pointerdown", (event) => { button.setPointerCapture(event.pointerId); button.classList.add("pressed"); press(axis.i, sign, button); });
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) button.addEventListener(name, () => { button.classList.remove("pressed"); letGo(button); });
  button.addEventListener("contextmenu", (event) => event.preventDefault());
  button.addEventListener("keydown", (event) => { if ((event.key === " " || event.key === "Enter") && !event.repeat) press(axis.i, sign, button); });
  button.addEventListener("keyup", () => letGo(button));
  button.addEventListener("blur", () => letGo(button));
  return button;
}

function buildPad() {
  $("jogpad").replaceChildren(...machine.axes.flatMap((axis) => [jogButton(axis, -1), jogButton(axis, 1)]));
}

const typing = (element) => element.matches("input:not([type=checkbox]):not([type=range]),select,textarea");

function listenToKeys() {
  addEventListener("keydown", (event) => {
    const key = KEYS[event.key];
    if (!key || !$("jogkeys").checked || typing(event.target) || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    if (!event.repeat && machine.axes.some((axis) => axis.i === key[0])) press(...key, event.key);
  }, true);
  addEventListener("keyup", (event) => letGo(event.key), true);
  addEventListener("blur", () => letGo());
  document.addEventListener("visibilitychange", () => { if (document.hidden) letGo(); });
  addEventListener("pagehide", () => letGo());
}

function showHistory() {
  $("mdihistory").replaceChildren(...[...history].reverse().map((line) => make("li", {}, make("button", { textContent: line, onclick: () => { $("mdiline").value = line; $("mdiline").focus(); } }))));
}

function remember(line) {
  if (history[history.length - 1] !== line) history.push(line);
  history.splice(0, Math.max(0, history.length - 50));
  place = history.length;
  localStorage.setItem("mdi", JSON.stringify(history));
  showHistory();
}

export async function runLine(line) {
  const refused = await told(write(["MODE", 1], ["MDI_TEXT", line], ["MDI_START", 1]), line);
  if (!refused) remember(line);
  return refused;
}

async function submit(event) {
  event.preventDefault();
  const line = $("mdiline").value.trim();
  if (line && !await runLine(line)) $("mdiline").value = "";
}

function leaf(event) {
  const way = { ArrowUp: -1, ArrowDown: 1 }[event.key];
  if (!way) return;
  event.preventDefault();
  place = Math.min(history.length, Math.max(0, place + way));
  $("mdiline").value = history[place] || "";
}

function claim(on) {
  clearInterval(claimed);
  claimed = 0;
  told(write(["WATCHDOG", on ? CLAIMED_MS : 0]), "Control").then((refused) => {
    if (!refused && on) claimed = setInterval(() => send({ alive: 1 }), CLAIMED_ALIVE_MS);
  });
}

function show(frame) {
  setText($("control"), ["", "you are in control", "another panel is in control"][frame.c]);
  setText($("claim"), claimed ? "Give control up" : "Take control");
  $("claim").disabled = frame.c === 2;
  $("home").disabled = !isState(STATE.IDLE);
  if (frame.c === 2 && claimed) { clearInterval(claimed); claimed = 0; }
}

export function startJog() {
  hear("hello", buildPad);
  hear("draw", show);
  hear("lost", () => { if (jog) clearInterval(jog.timer); jog = null; clearInterval(claimed); claimed = 0; });
  listenToKeys();
  $("claim").onclick = () => claim(!claimed);
  $("home").onclick = () => told(write(["MODE", 2], ["HOME", 1]), "Home");
  $("mdi").addEventListener("submit", submit);
  $("mdiline").addEventListener("keydown", leaf);
  $("locked").addEventListener("submit", (event) => { event.preventDefault(); told(write(["PASSWORD", Number($("password").value)]), "Password").then((refused) => { if (!refused) $("locked").hidden = true; }); });
  showHistory();
}
