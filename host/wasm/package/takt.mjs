// takt in a module of WebAssembly: the firmware, the desk's drives and the judge, as host/library/library.h shows them.

import { createSystem } from "./wasi.mjs";

const KEEPS_REPORT = 2;
const CYCLES_A_STEP = 20000n;
// Of structs, as layout.c has them.
const TEXT = { size: 12, name: 0, bytes: 4, length: 8 };
const MESSAGE = { size: 24, kind: 0, file: 4, line: 8, column: 12, text: 16, cure: 20 };
const STATE = { size: 216, cycles: 8, line: 28, cycle: 40, digest: 208 };

const encoder = new TextEncoder();
const decoder = new TextDecoder();
const toBytes = (text) => (typeof text === "string" ? encoder.encode(text) : text);

/** One call of a command. Its module and all of its memory are its own. */
class Job {
  constructor(module, words, files) {
    const system = createSystem(module);
    const instance = new WebAssembly.Instance(module, system.imports);
    this.c = instance.exports;
    system.begin(instance);
    this.job = this.c.takt_open(words.length, this.words(words), this.texts(Object.entries(files)), Object.keys(files).length);
    if (this.job === 0) throw new Error("out of memory");
  }

  get view() { return new DataView(this.c.memory.buffer); }

  place(bytes, zero) {
    const at = this.c.malloc(bytes.length + zero);
    if (at === 0) throw new Error("out of memory");
    const memory = new Uint8Array(this.c.memory.buffer);
    memory.set(bytes, at);
    if (zero) memory[at + bytes.length] = 0;
    return at;
  }

  words(words) {
    const at = words.map((word) => this.place(encoder.encode(word), 1));
    const list = this.c.malloc(4 * at.length + 4);
    at.forEach((word, i) => this.view.setUint32(list + 4 * i, word, true));
    return list;
  }

  texts(files) {
    const list = this.c.malloc(TEXT.size * files.length + 4);
    files.forEach(([name, text], i) => {
      const bytes = toBytes(text);
      const row = list + TEXT.size * i;
      const placed = [this.place(encoder.encode(name), 1), this.place(bytes, 0)];
      this.view.setUint32(row + TEXT.name, placed[0], true);
      this.view.setUint32(row + TEXT.bytes, placed[1], true);
      this.view.setUint32(row + TEXT.length, bytes.length, true);
    });
    return list;
  }

  string(at) {
    const memory = new Uint8Array(this.c.memory.buffer);
    return decoder.decode(memory.subarray(at, memory.indexOf(0, at)));
  }

  messages() {
    const count = this.c.malloc(4);
    const list = this.c.takt_get_messages(this.job, count);
    return Array.from({ length: this.view.getUint32(count, true) }, (_, i) => {
      const row = list + MESSAGE.size * i;
      const word = (offset) => this.view.getUint32(row + offset, true);
      return {
        kind: this.string(word(MESSAGE.kind)), file: this.string(word(MESSAGE.file)), line: word(MESSAGE.line), column: word(MESSAGE.column),
        text: this.string(word(MESSAGE.text)), cure: this.string(word(MESSAGE.cure)),
      };
    });
  }

  /** What the last call has written: bytes of its own. */
  bytes() {
    const length = this.c.malloc(4);
    const at = this.c.takt_get_text(this.job, length);
    return new Uint8Array(this.c.memory.buffer, at, this.view.getUint32(length, true)).slice();
  }

  state() {
    const at = this.c.malloc(STATE.size);
    this.c.takt_get_state(this.job, at);
    const view = this.view;
    const state = {
      cycles: Number(view.getBigUint64(at + STATE.cycles, true)), line: view.getUint32(at + STATE.line, true),
      cycleSeconds: view.getFloat64(at + STATE.cycle, true), digest: view.getBigUint64(at + STATE.digest, true).toString(16).padStart(16, "0"),
    };
    this.c.free(at);
    return state;
  }
}

/** Lines passed, of those there are: loops and subroutines go back, progress does not. */
function follow(job, lines, onProgress) {
  let done = 0;
  return () => {
    const state = job.state();
    done = Math.max(done, Math.min(1, state.line / lines));
    onProgress({ done, line: state.line, programTime: state.cycles * state.cycleSeconds });
  };
}

function failed(job, status) {
  return { status, summary: null, messages: job.messages(), report: null };
}

export class Takt {
  constructor(module) { this.module = module; }

  /** The words of a command line (`run` first), files by name. */
  run(words, files, { report = false, onProgress = null } = {}) {
    const job = new Job(this.module, words, files);
    let status = job.c.takt_start(job.job, report ? KEEPS_REPORT : 0);
    if (status !== 0) return failed(job, status);
    const lines = decoder.decode(toBytes(files[words[1]] ?? "")).split("\n").length;
    const tell = onProgress ? follow(job, lines, onProgress) : () => {};
    while (status === 0 && !job.c.takt_is_over(job.job)) {
      status = job.c.takt_step(job.job, CYCLES_A_STEP);
      tell();
    }
    if (status !== 0) return failed(job, status);
    status = job.c.takt_finish(job.job, 0);
    const summary = JSON.parse(decoder.decode(job.bytes()));
    const written = report && job.c.takt_write_report(job.job) === 0 ? decoder.decode(job.bytes()) : null;
    return { status, summary, messages: job.messages(), report: written };
  }

  /** canon, plan, compile or machine: what the command writes. */
  write(words, files) {
    const job = new Job(this.module, words, files);
    const status = job.c.takt_write(job.job);
    return { status, bytes: job.bytes(), messages: job.messages() };
  }

  version() {
    const job = new Job(this.module, ["run"], {});
    return job.string(job.c.takt_library_version());
  }
}
