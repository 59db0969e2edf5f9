"use strict";
/* The try-it page: files in, a worker runs them, figures and pictures out. */

const at = (id) => document.getElementById(id);
const EXAMPLE = "G21 G90 G64 P0.02 F3000\nG0 Z2\nG0 X0 Y0\nG1 Z-1 F600\nF3000\n#1=0\no1 while [#1 lt 360]\n  G1 X[20+[20+6*SIN[9*#1]]*COS[#1]] Y[20+[20+6*SIN[9*#1]]*SIN[#1]]\n  #1=[#1+3]\no1 endwhile\nG0 Z2\nM2\n";
const PROGRAMS = /\.(ngc|nc|gcode|g|tap|cnc|mpf|txt)$/i;
const takt = { files: {}, program: null, worker: null, result: null, url: null, warm: false };
window.takt = takt;

function element(tag, attributes, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

async function unpack(id) {
  const text = at(id).textContent.trim();
  const packed = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

const compiled = unpack("module").then((bytes) => WebAssembly.compile(bytes));
const workerUrl = URL.createObjectURL(new Blob([at("worker").textContent], { type: "text/javascript" }));

/* The browser makes machine code of what runs often. So the example runs once while a file is waited for. */
compiled.then((module) => {
  const warming = new Worker(workerUrl);
  warming.onmessage = ({ data }) => {
    if (data.progress) return;
    warming.terminate();
    takt.warm = true;
  };
  warming.postMessage({ id: 0, module, words: ["run", "example.ngc"], files: { "example.ngc": EXAMPLE }, report: true });
});

/* ---- files ---- */

function optionOf(name) {
  if (/\.ini$/i.test(name)) return ["--machine", name];
  if (/\.tbl$/i.test(name)) return ["--tools", name];
  if (/\.var$/i.test(name)) return ["--parameters", name];
  return [];
}

async function takeFiles(list) {
  for (const file of list) {
    takt.files[file.name] = new Uint8Array(await file.arrayBuffer());
    if (optionOf(file.name).length === 0) takt.program = file.name;
  }
  showFiles();
  if (takt.program) run();
}

function showFiles() {
  at("names").textContent = Object.keys(takt.files).join(", ");
  at("run").disabled = !takt.program;
}

function wordsOf() {
  const others = Object.keys(takt.files).filter((name) => !PROGRAMS.test(name) && name !== takt.program);
  return ["run", takt.program, ...others.flatMap(optionOf), ...at("options").value.split(/\s+/).filter(Boolean)];
}

/* ---- the run ---- */

function finish() {
  takt.worker?.terminate();
  takt.worker = null;
  at("stop").hidden = at("progress").hidden = true;
  at("run").disabled = !takt.program;
}

function hear({ progress, result, error }) {
  if (progress) {
    at("progress").value = progress.done;
    at("state").textContent = `line ${progress.line}, ${progress.programTime.toFixed(1)} s of the machine`;
    return;
  }
  finish();
  if (error) at("state").textContent = error;
  else show(result);
}

async function run() {
  finish();
  const module = await compiled;
  takt.result = null;
  at("result").hidden = true;
  at("messages").replaceChildren();
  at("progress").value = 0;
  at("progress").hidden = at("stop").hidden = false;
  at("run").disabled = true;
  at("state").textContent = "reading, planning";
  takt.began = performance.now();
  takt.worker = new Worker(workerUrl);
  takt.worker.onmessage = (event) => hear(event.data);
  takt.worker.onerror = (event) => hear({ error: event.message });
  takt.worker.postMessage({ id: 1, module, words: wordsOf(), files: takt.files, report: true });
}

/* ---- what came of it ---- */

function showMessages(messages) {
  at("messages").replaceChildren(...messages.map((m) =>
    element("li", { class: m.kind }, `${m.file ? `${m.file}:${m.line}:${m.column}: ` : ""}${m.kind}: ${m.text}${m.cure ? `\n${m.cure.trimEnd()}` : ""}`)));
}

function showFigures(summary, wall_s) {
  const held = summary.checks.filter((check) => check.held).length;
  const seconds = summary.program_time_s;
  const rows = {
    Outcome: summary.outcome, "Program time": `${Math.floor(seconds / 60)}:${(seconds % 60).toFixed(3).padStart(6, "0")}`,
    Path: `${summary.path_length_mm.toFixed(3)} mm`, Checks: `${held} of ${summary.checks.length} held`,
    Digest: summary.setpoint_digest, "Judged here in": `${wall_s.toFixed(1)} s`,
  };
  at("figures").replaceChildren(...Object.entries(rows).map(([name, value]) => element("div", {}, element("dt", {}, name),
    element("dd", { id: `figure-${name.toLowerCase().replace(/ /g, "-")}`, class: name === "Checks" ? (held === summary.checks.length ? "held" : "broken") : "" }, value))));
  const broken = summary.checks.filter((check) => !check.held).map((check) => element("li", { class: "broken" }, `check ${check.name} is broken: ${check.value}, limit ${check.limit}`));
  at("messages").append(...broken);
}

function showAxes(axes) {
  const cell = (value, limit) => element("td", {}, `${value.toPrecision(6)} / ${limit} (${(100 * value / limit).toFixed(1)} %)`);
  at("axes").replaceChildren(
    element("tr", {}, ...["Axis", "Velocity / limit, 1/s", "Acceleration, 1/s²", "Jerk, 1/s³"].map((name) => element("th", {}, name))),
    ...axes.map((axis) => element("tr", {}, element("th", {}, axis.name), cell(axis.max_velocity_mm_s ?? axis.max_velocity_deg_s, axis.limit_velocity_mm_s ?? axis.limit_velocity_deg_s),
      cell(axis.max_acceleration_mm_s2 ?? axis.max_acceleration_deg_s2, axis.limit_acceleration_mm_s2 ?? axis.limit_acceleration_deg_s2),
      cell(axis.max_jerk_mm_s3 ?? axis.max_jerk_deg_s3, axis.limit_jerk_mm_s3 ?? axis.limit_jerk_deg_s3))));
}

async function keepReport(report) {
  const plotting = at("plotting").textContent.trim() ? new TextDecoder().decode(await unpack("plotting")) : "";
  const [open, close] = ["<script>", "<" + "/script>"];
  const whole = plotting ? report.replace(open + close, () => open + plotting + close) : report;
  if (takt.url) URL.revokeObjectURL(takt.url);
  takt.url = at("save").href = URL.createObjectURL(new Blob([whole], { type: "text/html" }));
  at("report").hidden = true;
  at("report").removeAttribute("src");
}

async function show(result) {
  showMessages(result.messages);
  at("state").textContent = result.summary ? "" : "the program was not run";
  if (result.summary) {
    showFigures(result.summary, (performance.now() - takt.began) / 1000);
    showAxes(result.summary.axes);
    at("result").hidden = false;
    await keepReport(result.report);
    path.take(result.report);
  }
  takt.result = result;
}

/* ---- the path: an orthographic view, drawn once a frame ---- */

const path = {
  points: null, turn: -0.6, tilt: 0.9, zoom: 1, asked: false,

  take(report) {
    const data = JSON.parse(/id="run-data">([\s\S]*?)<\/script>/.exec(report)[1]);
    const column = (name, Type) => new Type(Uint8Array.from(atob(data.path[name]), (character) => character.charCodeAt(0)).buffer);
    const count = data.path.count;
    const flat = new Float32Array(count);
    this.points = { count, X: flat, Y: flat, Z: flat, feed: column("feed", Float32Array), rapid: column("rapid", Uint8Array) };
    for (const name of "XYZ") if (data.path[name] !== undefined) this.points[name] = column(name, Float32Array);
    this.frame();
    this.ask();
  },

  frame() {
    const span = (values) => values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
    const spans = ["X", "Y", "Z"].map((name) => span(this.points[name]));
    this.middle = spans.map(([low, high]) => (low + high) / 2);
    this.size = Math.max(1e-3, Math.hypot(...spans.map(([low, high]) => high - low)));
    this.fastest = this.points.feed.reduce((most, value) => Math.max(most, value), 1e-9);
  },

  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => { this.asked = false; this.draw(); });
  },

  project(k) {
    const [x, y, z] = [this.points.X[k] - this.middle[0], this.points.Y[k] - this.middle[1], this.points.Z[k] - this.middle[2]];
    const right = x * Math.cos(this.turn) - y * Math.sin(this.turn);
    const away = x * Math.sin(this.turn) + y * Math.cos(this.turn);
    return [right, away * Math.cos(this.tilt) + z * Math.sin(this.tilt)];
  },

  draw() {
    const canvas = at("path");
    const pen = canvas.getContext("2d");
    const scale = 0.9 * this.zoom * canvas.height / this.size;
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.lineWidth = 1.5;
    let [fromX, fromY] = this.project(0);
    for (let k = 1; k < this.points.count; k++) {
      const [toX, toY] = this.project(k);
      pen.strokeStyle = this.points.rapid[k] ? "#98a4b0" : `hsl(${(250 - 190 * this.points.feed[k] / this.fastest).toFixed(0)} 70% 48%)`;
      pen.beginPath();
      pen.moveTo(canvas.width / 2 + fromX * scale, canvas.height / 2 - fromY * scale);
      pen.lineTo(canvas.width / 2 + toX * scale, canvas.height / 2 - toY * scale);
      pen.stroke();
      [fromX, fromY] = [toX, toY];
    }
    canvas.dataset.points = String(this.points.count);
  },
};

at("path").addEventListener("pointermove", (event) => {
  if (!event.buttons || !path.points) return;
  path.turn += event.movementX / 150;
  path.tilt = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, path.tilt - event.movementY / 150));
  path.ask();
});
at("path").addEventListener("wheel", (event) => {
  event.preventDefault();
  path.zoom *= Math.exp(-event.deltaY / 500);
  if (path.points) path.ask();
}, { passive: false });

/* ---- controls ---- */

at("files").addEventListener("change", () => takeFiles([...at("files").files]));
at("run").addEventListener("click", run);
at("stop").addEventListener("click", () => { finish(); at("state").textContent = "stopped"; });
at("example").addEventListener("click", () => takeFiles([new File([EXAMPLE], "example.ngc")]));
at("show").addEventListener("click", () => {
  at("report").src = takt.url;
  at("report").hidden = false;
});
document.body.addEventListener("dragover", (event) => { event.preventDefault(); at("drop").classList.add("over"); });
document.body.addEventListener("dragleave", () => at("drop").classList.remove("over"));
document.body.addEventListener("drop", (event) => {
  event.preventDefault();
  at("drop").classList.remove("over");
  takeFiles([...event.dataTransfer.files]);
});
