import { readFile } from "node:fs/promises";
import { Takt } from "./takt.mjs";

export { Takt };

/** The module beside this file, or the bytes given. */
export async function load(bytes) {
  return new Takt(await WebAssembly.compile(bytes ?? (await readFile(new URL("./takt.wasm", import.meta.url)))));
}
