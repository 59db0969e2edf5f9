// In a worker: { id, module, words, files, report } comes; { id, progress }, and at last { id, result } or { id, error }, go.

import { Takt } from "./takt.mjs";

onmessage = ({ data: { id, module, words, files, report } }) => {
  try {
    const result = new Takt(module).run(words, files, { report, onProgress: (progress) => postMessage({ id, progress }) });
    postMessage({ id, result });
  } catch (error) {
    postMessage({ id, error: String(error) });
  }
};
