// node --test: what the package promises, against the digests of a takt of this computer where $TAKT names one.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { test } from "node:test";
import { load } from "./index.mjs";

const PROGRAM = "G21 G90 G64 P0.01 F3000\nG1 X5 Y3\nG2 X9 Y7 I0 J4\nG1 X4 Y9\nX3 Y9.2\nX2 Y5\nX0 Y0\nM2\n";
const takt = await load();

test("a run has a time, a digest and checks that held", () => {
  const { status, summary, messages } = takt.run(["run", "part.ngc"], { "part.ngc": PROGRAM });
  assert.equal(status, 0);
  assert.deepEqual(messages, []);
  assert.equal(summary.outcome, "completed");
  assert.ok(summary.checks.length > 5 && summary.checks.every((check) => check.held));
  assert.match(summary.setpoint_digest, /^[0-9a-f]{16}$/);
});

test("two runs are the same, and a machine that differs is not", () => {
  const digest = (...words) => takt.run(["run", "part.ngc", ...words], { "part.ngc": PROGRAM }).summary.setpoint_digest;
  assert.equal(digest(), digest());
  assert.notEqual(digest(), digest("--set", "axis.X.max_jerk_mm_s3=20000"));
});

test("the digest is that of the takt command", { skip: !process.env.TAKT }, () => {
  const words = ["run", "-", "--json", "-", "--quiet"];
  const there = JSON.parse(execFileSync(process.env.TAKT, words, { input: PROGRAM }).toString());
  const here = takt.run(["run", "part.ngc"], { "part.ngc": PROGRAM }).summary;
  assert.equal(here.setpoint_digest, there.setpoint_digest);
  assert.equal(here.program_time_s, there.program_time_s);
});

test("an error names line and column, and there is no summary", () => {
  const { status, summary, messages } = takt.run(["run", "part.ngc"], { "part.ngc": "G21 G90\nG1 F100 X1 Q\nM2\n" });
  assert.equal(status, 2);
  assert.equal(summary, null);
  assert.deepEqual([messages[0].kind, messages[0].file, messages[0].line], ["error", "part.ngc", 2]);
});

test("a file that is not handed over is not found", () => {
  const { status, messages } = takt.run(["run", "part.ngc", "--machine", "mill.ini"], { "part.ngc": PROGRAM });
  assert.equal(status, 2);
  assert.match(messages[0].text, /cannot be opened/);
});

test("progress grows to the end", () => {
  const seen = [];
  takt.run(["run", "part.ngc"], { "part.ngc": PROGRAM }, { onProgress: ({ done }) => seen.push(done) });
  assert.ok(seen.length > 0 && seen.at(-1) > 0.5);
  assert.deepEqual(seen, [...seen].sort((a, b) => a - b));
});

test("a program that is compiled runs planned ahead", () => {
  const { status, bytes } = takt.write(["compile", "part.ngc"], { "part.ngc": PROGRAM });
  assert.equal(status, 0);
  const { summary } = takt.run(["run", "part.ngc", "--plan", "part.plan"], { "part.ngc": PROGRAM, "part.plan": bytes });
  assert.equal(summary.outcome, "completed");
});

test("the report is a page", () => {
  const { report } = takt.run(["run", "part.ngc"], { "part.ngc": PROGRAM }, { report: true });
  assert.match(report, /^<!DOCTYPE html>/);
});

test("the machine that is built in can be read and handed back", () => {
  const { bytes } = takt.write(["machine"], {});
  const { status } = takt.run(["run", "part.ngc", "--machine", "mill.ini"], { "part.ngc": PROGRAM, "mill.ini": bytes });
  assert.equal(status, 0);
});
