// The program, the tool, the way it has gone and the limits of travel, seen from any side, without perspective.
//
// What rarely changes is drawn into a layer of its own; every frame adds the trail, the active line and the tool.

import { hear } from "./link.js";
import { machine, counts, axisValue } from "./state.js";
import { $, colour, setText, sized } from "./dom.js";

const TRAIL_MAX = 12000;
const STRIDE = 5; // numbers of a point: x y z line rapid
const SIDES = { iso: [-0.65, 0.6], top: [0, Math.PI / 2], front: [0, 0], side: [-Math.PI / 2, 0] };

const canvas = $("view");
const layer = document.createElement("canvas");
const camera = { yaw: SIDES.iso[0], pitch: SIDES.iso[1], scale: 1, x: 0, y: 0 };
let points = new Float32Array(0), lines = new Uint32Array(0);
let firstOf = new Map();
let trail = [];
let stale = true, fitted = false, drawn = "";

// Rows of the turn about z by yaw, then about the screen's x by pitch: across and up on the screen.
function axesOfScreen() {
  const [cy, sy, cp, sp] = [Math.cos(camera.yaw), Math.sin(camera.yaw), Math.cos(camera.pitch), Math.sin(camera.pitch)];
  return { right: [cy, -sy, 0], up: [sy * sp, cy * sp, cp] };
}

function projector(width, height) {
  const { right, up } = axesOfScreen();
  const s = camera.scale, cx = width / 2 + camera.x, cy = height / 2 + camera.y;
  return (x, y, z) => [cx + s * (right[0] * x + right[1] * y + right[2] * z), cy - s * (up[0] * x + up[1] * y + up[2] * z)];
}

function travel() {
  const box = [[0, 0], [0, 0], [0, 0]];
  for (const axis of machine.axes) if (axis.i < 3) box[axis.i] = [axis.limits[4], axis.limits[5]];
  return box;
}

// The program where there is one, else the machine.
function bounds() {
  const box = [[Infinity, -Infinity], [Infinity, -Infinity], [Infinity, -Infinity]];
  for (let i = STRIDE; i < points.length; i += STRIDE) {
    for (let k = 0; k < 3; k += 1) {
      box[k][0] = Math.min(box[k][0], points[i + k]);
      box[k][1] = Math.max(box[k][1], points[i + k]);
    }
  }
  return points.length > STRIDE ? box : travel();
}

export function fit() {
  const size = sized(canvas);
  if (!size) return;
  const box = bounds();
  Object.assign(camera, { scale: 1, x: 0, y: 0 });
  const at = projector(0, 0);
  let [left, right, top, bottom] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let corner = 0; corner < 8; corner += 1) {
    const [x, y] = at(box[0][corner & 1], box[1][corner >> 1 & 1], box[2][corner >> 2 & 1]);
    [left, right, top, bottom] = [Math.min(left, x), Math.max(right, x), Math.min(top, y), Math.max(bottom, y)];
  }
  camera.scale = 0.82 * Math.min(size.width / Math.max(right - left, 1e-3), size.height / Math.max(bottom - top, 1e-3));
  camera.x = -camera.scale * (left + right) / 2;
  camera.y = -camera.scale * (top + bottom) / 2;
  stale = true;
  fitted = true;
}

function strokeBox(context, at, box, style) {
  context.strokeStyle = style;
  context.beginPath();
  for (let corner = 0; corner < 8; corner += 1) {
    for (let k = 0; k < 3; k += 1) {
      if (corner >> k & 1) continue;
      const other = corner | 1 << k;
      context.moveTo(...at(box[0][corner & 1], box[1][corner >> 1 & 1], box[2][corner >> 2 & 1]));
      context.lineTo(...at(box[0][other & 1], box[1][other >> 1 & 1], box[2][other >> 2 & 1]));
    }
  }
  context.stroke();
}

function strokeAxes(context, at, length) {
  ["x", "y", "z"].forEach((name, k) => {
    const end = [0, 0, 0];
    end[k] = length;
    context.strokeStyle = context.fillStyle = colour(name);
    context.beginPath();
    context.moveTo(...at(0, 0, 0));
    context.lineTo(...at(...end));
    context.stroke();
    context.fillText(name.toUpperCase(), ...at(...end));
  });
}

// Rapid moves dashed and pale. Pieces shorter than half a pixel are left out.
function strokeProgram(context, at, rapid, ratio) {
  let [px, py, pen] = [NaN, NaN, false];
  context.strokeStyle = colour(rapid ? "rapid" : "ink");
  context.setLineDash(rapid ? [3 * ratio, 3 * ratio] : []);
  context.beginPath();
  for (let i = 0; i < points.length; i += STRIDE) {
    const [x, y] = at(points[i], points[i + 1], points[i + 2]);
    const mine = (points[i + 4] !== 0) === rapid && i > 0;
    if (mine && Math.abs(x - px) + Math.abs(y - py) < 0.5 && i + STRIDE < points.length) continue;
    if (mine && !pen) context.moveTo(px, py);
    if (mine) context.lineTo(x, y);
    [px, py, pen] = [x, y, mine];
  }
  context.stroke();
  context.setLineDash([]);
}

function drawLayer(size) {
  Object.assign(layer, { width: size.width, height: size.height });
  const context = layer.getContext("2d"), at = projector(size.width, size.height);
  context.font = `${12 * size.ratio}px system-ui`;
  context.lineWidth = size.ratio;
  strokeBox(context, at, travel(), colour("line"));
  strokeAxes(context, at, 60 * size.ratio / camera.scale);
  strokeProgram(context, at, true, size.ratio);
  strokeProgram(context, at, false, size.ratio);
  stale = false;
}

function strokeTrail(context, at, ratio) {
  context.strokeStyle = colour("trail");
  context.lineWidth = 2 * ratio;
  context.beginPath();
  for (let i = 0; i < trail.length; i += 3) context[i ? "lineTo" : "moveTo"](...at(trail[i], trail[i + 1], trail[i + 2]));
  context.stroke();
}

function strokeActive(context, at, ratio) {
  const line = counts("ACTIVE_LINE"), first = firstOf.get(line);
  if (!line || first === undefined) return;
  context.strokeStyle = colour("accent");
  context.lineWidth = 3 * ratio;
  context.beginPath();
  for (let p = Math.max(first - 1, 0); p < lines.length && (p < first || lines[p] === line); p += 1) {
    context[p < first || p === 0 ? "moveTo" : "lineTo"](...at(...points.subarray(p * STRIDE, p * STRIDE + 3)));
  }
  context.stroke();
}

// A cone with its tip at the setpoint.
function drawTool(context, at, ratio) {
  const place = [0, 0, 0];
  for (const axis of machine.axes) if (axis.i < 3) place[axis.i] = axisValue("POSITION", axis);
  const [x, y] = at(...place), [tx, ty] = at(place[0], place[1], place[2] + 26 * ratio / camera.scale);
  const [nx, ny] = [8 * ratio, 3 * ratio];
  context.fillStyle = colour("accent");
  context.globalAlpha = 0.8;
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(tx - nx, ty);
  context.ellipse(tx, ty, nx, ny + 1, 0, Math.PI, 0);
  context.closePath();
  context.fill();
  context.globalAlpha = 1;
  context.beginPath();
  context.arc(x, y, 2.5 * ratio, 0, 7);
  context.fill();
}

function draw() {
  const size = sized(canvas);
  if (size && machine.frame) {
    if (!fitted) fit();
    if (stale || layer.width !== size.width || layer.height !== size.height) drawLayer(size);
    const at = projector(size.width, size.height), { context, ratio } = size;
    context.clearRect(0, 0, size.width, size.height);
    context.drawImage(layer, 0, 0);
    strokeTrail(context, at, ratio);
    strokeActive(context, at, ratio);
    drawTool(context, at, ratio);
  }
}

// Lengthened by every frame; when it is too long its older half keeps every second point.
function lengthen(more) {
  for (let i = 0; i < more.length; i += 3) {
    const end = trail.length - 3;
    if (end < 0 || Math.abs(more[i] - trail[end]) + Math.abs(more[i + 1] - trail[end + 1]) + Math.abs(more[i + 2] - trail[end + 2]) > 1e-3) trail.push(more[i], more[i + 1], more[i + 2]);
  }
  if (trail.length > 3 * TRAIL_MAX) trail = trail.filter((_, i) => i > trail.length / 2 || Math.floor(i / 3) % 2);
}

async function load({ path: [size, crc, count, problem] }) {
  const bytes = size ? await (await fetch("/path")).arrayBuffer() : new ArrayBuffer(0);
  points = new Float32Array(bytes);
  const words = new Uint32Array(bytes);
  lines = Uint32Array.from({ length: points.length / STRIDE }, (_, i) => words[i * STRIDE + 3]);
  for (let i = 0; i < points.length; i += STRIDE) points[i + 4] = words[i + 4];
  firstOf = new Map();
  lines.forEach((line, i) => { if (!firstOf.has(line)) firstOf.set(line, i); });
  stale = true;
  if (drawn !== `${size} ${crc}`) [trail, fitted] = [[], false];
  drawn = `${size} ${crc}`;
  canvas.dataset.points = count;
  setText($("viewnote"), problem);
}

function turn(dx, dy) {
  camera.yaw += dx;
  camera.pitch = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, camera.pitch + dy));
  stale = true;
}

function zoom(factor, x = 0, y = 0) {
  camera.scale *= factor;
  camera.x = x + (camera.x - x) * factor;
  camera.y = y + (camera.y - y) * factor;
  stale = true;
}

const fingers = new Map();

function drag(event) {
  const before = fingers.get(event.pointerId);
  if (!before) return;
  const ratio = window.devicePixelRatio || 1;
  const [dx, dy] = [event.clientX - before[0], event.clientY - before[1]];
  if (fingers.size === 2) {
    const other = [...fingers].find(([id]) => id !== event.pointerId)[1];
    zoom(Math.hypot(event.clientX - other[0], event.clientY - other[1]) / Math.max(Math.hypot(before[0] - other[0], before[1] - other[1]), 1));
  } else if (event.shiftKey || event.buttons & 6) {
    Object.assign(camera, { x: camera.x + dx * ratio, y: camera.y + dy * ratio });
    stale = true;
  } else {
    turn(-dx * 0.008, dy * 0.008);
  }
  fingers.set(event.pointerId, [event.clientX, event.clientY]);
}

const KEYS = { ArrowLeft: () => turn(0.1, 0), ArrowRight: () => turn(-0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1), "+": () => zoom(1.2), "-": () => zoom(1 / 1.2), f: fit };

function press(name) {
  if (name === "clear") { trail = []; return; }
  if (SIDES[name]) [camera.yaw, camera.pitch] = SIDES[name];
  fit();
}

export function startView() {
  hear("frame", (frame) => lengthen(frame.p));
  hear("path", load);
  hear("hello", () => { fitted = false; });
  canvas.addEventListener("pointerdown", (event) => { fingers.set(event.pointerId, [event.clientX, event.clientY]); canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointermove", drag);
  for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => fingers.delete(event.pointerId));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => { event.preventDefault(); zoom(Math.exp(-event.deltaY * 0.001)); }, { passive: false });
  canvas.addEventListener("keydown", (event) => { if (KEYS[event.key]) { KEYS[event.key](); event.preventDefault(); } });
  $("viewbuttons").addEventListener("click", (event) => { if (event.target.dataset.view) press(event.target.dataset.view); });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { stale = true; });
  new ResizeObserver(() => { fitted = false; }).observe(canvas);
  hear("draw", draw);
}
