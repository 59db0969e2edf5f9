#!/usr/bin/env node
// takt-wasm run PROGRAM [options of takt run] | compile PROGRAM [-o FILE] | canon, plan PROGRAM | machine [FILE]
//
// Prints the summary as JSON, or what the command writes. Words that are names of files are read.

import { existsSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { load } from "./index.mjs";

// Of options whose value names an output: it is written here.
function split(words) {
  const kept = [];
  let output = null;
  for (let i = 0; i < words.length; i++) {
    if (["-o", "--output"].includes(words[i])) output = words[++i];
    else if (words[i] === "--json") i++;
    else if (words[i] !== "--quiet") kept.push(words[i]);
  }
  return { kept, output };
}

function filesOf(words) {
  const names = words.map((word) => word.slice(word.indexOf("=") + 1));
  return Object.fromEntries(names.filter((name) => existsSync(name) && statSync(name).isFile()).map((name) => [name, readFileSync(name)]));
}

const { kept, output } = split(process.argv.slice(2));
if (kept.length === 0) {
  console.error("usage: takt-wasm run|compile|canon|plan|machine FILE [options]");
  process.exit(2);
}
const takt = await load();
const files = filesOf(kept);
const done = kept[0] === "run" ? takt.run(kept, files) : takt.write(kept, files);
for (const { kind, file, line, column, text, cure } of done.messages) console.error(`${file ? `${file}:${line}:${column}: ` : "takt: "}${kind}: ${text}\n${cure}`.trimEnd());
if (done.summary) process.stdout.write(`${JSON.stringify(done.summary, null, "\t").replace(/": /g, "\":\t")}\n`);
if (done.bytes && done.status === 0) writeFileSync(output ?? process.stdout.fd, done.bytes);
process.exitCode = done.status;
