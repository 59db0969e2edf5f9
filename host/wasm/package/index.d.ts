/** A message about a program or a file; line and column from 1, 0 where there is none. */
export interface Message {
  kind: "error" | "warning" | "message" | "note";
  file: string;
  line: number;
  column: number;
  text: string;
  /** What to do about it; "" for nothing. */
  cure: string;
}

export interface Progress {
  /** 0 to 1, by lines. */
  done: number;
  line: number;
  /** Of the machine, in seconds. */
  programTime: number;
}

export interface Result {
  /** Exit status of `takt run`: 0 all checks held, 1 one did not, 2 the program or a file has an error, 4 --until came. */
  status: number;
  /** `takt run --json`; null after an error. Its schema is host/takt/summary.schema.json. */
  summary: Summary | null;
  messages: Message[];
  /** HTML, if it was asked for. */
  report: string | null;
}

export interface Summary {
  outcome: "completed" | "stopped" | "faulted" | "interrupted";
  program_time_s: number;
  cycles: number;
  setpoint_digest: string;
  path_length_mm: number;
  checks: { name: string; held: boolean; value: number; limit: number }[];
  [key: string]: unknown;
}

/** Texts by the names that the words of a command give them. */
export type Files = Record<string, string | Uint8Array>;

export class Takt {
  constructor(module: WebAssembly.Module);
  /** `takt run`: words are those of its command line, "run" first, the program second. */
  run(words: string[], files: Files, options?: { report?: boolean; onProgress?: (progress: Progress) => void }): Result;
  /** `takt canon`, `plan`, `compile` or `machine`: the bytes that it writes. */
  write(words: string[], files: Files): { status: number; bytes: Uint8Array; messages: Message[] };
  version(): string;
}

export function load(bytes?: BufferSource): Promise<Takt>;
