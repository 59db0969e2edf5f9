// A chart of the last seconds, with lines at the limits.

import { colour, sized } from "./dom.js";

const SAMPLES = 300;

export class Strip {
  constructor(canvas) {
    this.canvas = canvas;
    this.values = new Float64Array(SAMPLES);
    this.at = 0;
  }

  add(value) {
    this.values[this.at % SAMPLES] = value;
    this.at += 1;
  }

  // limit 0: there is none, and the largest value fills the height.
  draw(limit, name) {
    const size = sized(this.canvas);
    if (!size) return;
    const { context, width, height, ratio } = size;
    const most = this.values.reduce((peak, v) => Math.max(peak, Math.abs(v)), 0);
    const full = 1.12 * (Math.max(limit, most) || 1);
    const y = (value) => height / 2 * (1 - value / full);
    context.clearRect(0, 0, width, height);
    context.lineWidth = ratio;
    this.rule(context, width, y(0), colour("line"));
    if (limit) for (const side of [-limit, limit]) this.rule(context, width, y(side), colour("stop"));
    context.strokeStyle = colour(name);
    context.lineWidth = 1.5 * ratio;
    context.beginPath();
    for (let i = 0; i < SAMPLES; i += 1) context.lineTo(width * i / (SAMPLES - 1), y(this.values[(this.at + i) % SAMPLES]));
    context.stroke();
  }

  rule(context, width, y, style) {
    context.strokeStyle = style;
    context.beginPath();
    context.moveTo(0, y);
    context.lineTo(width, y);
    context.stroke();
  }
}
