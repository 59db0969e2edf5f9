// The machine as the last frame shows it: registers by name.

import { hear } from "./link.js";

export const AXES = "XYZABC";
export const STATES = ["starting", "idle", "running", "MDI", "jogging", "homing", "held", "stopping", "alarm", "emergency stop"];
export const STATE = { IDLE: 1, RUNNING: 2, MDI: 3, JOGGING: 4, HOMING: 5, HELD: 6, STOPPING: 7, ALARM: 8, EMERGENCY: 9 };
export const HOLDS = ["", "operator", "single block", "program stop", "spindle drive", "panel silent"];
export const ALARMS = ["", "program", "drive", "spindle", "panel silent", "emergency stop", "internal", "program starved"];
export const SYSTEMS = ["G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"];

export const machine = { hello: null, frame: null, index: new Map(), decimals: [], axes: [] };

hear("hello", ({ hello }) => {
  machine.hello = hello;
  hello.registers.forEach(([name, decimals], i) => { machine.index.set(name, i); machine.decimals[i] = decimals; });
  machine.axes = [...AXES].map((letter, i) => ({ letter, i, limits: hello.axes[i], rotary: i > 2 })).filter((axis) => axis.limits);
});
hear("frame", (frame) => { machine.frame = frame; });

export function counts(name) {
  return machine.frame ? machine.frame.v[machine.index.get(name)] : 0;
}

export function value(name) {
  return counts(name) / 10 ** (machine.decimals[machine.index.get(name)] || 0);
}

export function toCounts(name, number) {
  return Math.round(number * 10 ** machine.decimals[machine.index.get(name)]);
}

export function axisValue(name, axis) {
  return value(`${name}_${axis.letter}`);
}

export function isState(...states) {
  return states.includes(counts("STATE"));
}

// The active modes as words of a program.
export function modes() {
  const bits = counts("MODES");
  const motion = (bits >>> 16) / 10;
  const words = [motion === 80 ? "" : `G${motion}`, ["G17", "G18", "G19"][bits & 3], bits & 4 ? "G91" : "G90", bits & 8 ? "G20" : "G21",
    ["G61", "G61.1", "G64"][bits >> 4 & 3], ["G40", "G41", "G42"][bits >> 6 & 3], SYSTEMS[counts("SYSTEM") - 1],
    bits & 256 ? "G93" : bits & 512 ? "G95" : "G94", bits & 1024 ? "G98" : "G99", bits & 2048 ? "G96" : "G97", bits & 4096 ? "G7" : ""];
  return words.filter(Boolean).join(" ");
}
