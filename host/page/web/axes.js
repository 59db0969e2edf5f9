// Each axis live: velocity, acceleration, jerk and following error against its limits.

import { hear } from "./link.js";
import { machine } from "./state.js";
import { $, make, setText } from "./dom.js";
import { Strip } from "./strip.js";

const KINDS = [["velocity", "/s"], ["accel.", "/s²"], ["jerk", "/s³"], ["lag", ""]];
const COLOURS = ["x", "y", "z"];

let charts = [];

function chart(axis, kind) {
  const canvas = make("canvas"), number = make("b");
  const limit = axis.limits[kind];
  const unit = `${axis.rotary ? "°" : "mm"}${KINDS[kind][1]}`;
  const box = make("div", { className: "chart" }, make("header", {}, make("span", { textContent: `${axis.letter} ${KINDS[kind][0]}` }), number), canvas);
  box.dataset.chart = `${axis.letter}${kind}`;
  charts.push({ axis, kind, strip: new Strip(canvas), number, limit, unit, most: 0 });
  return box;
}

function build() {
  charts = [];
  $("axes").replaceChildren(make("div", { className: "charts" }, ...machine.axes.flatMap((axis) => KINDS.map((_, kind) => chart(axis, kind)))));
}

const short = (number) => (number >= 1e4 ? number.toFixed(0) : number.toPrecision(4));

// The number shown is the largest of the last seconds, as the strip has it.
function draw() {
  if ($("pane-axes").hidden) return;
  for (const c of charts) {
    c.most = c.strip.values.reduce((peak, v) => Math.max(peak, Math.abs(v)), 0);
    c.strip.draw(c.limit, COLOURS[c.axis.i % 3]);
    const part = c.limit ? ` · ${(100 * c.most / c.limit).toFixed(1)} %` : "";
    setText(c.number, `${short(c.most)} ${c.unit}${part}`);
    c.number.classList.toggle("over", c.limit > 0 && c.most > c.limit * 1.001);
  }
}

function add(frame) {
  for (const c of charts) c.strip.add(frame.x[c.axis.i][c.kind]);
}

export function startAxes() {
  hear("hello", build);
  hear("frame", add);
  hear("draw", draw);
}
