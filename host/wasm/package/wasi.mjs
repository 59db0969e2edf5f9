// What the module asks of a system (WASI, snapshot preview 1): files in memory, two streams for text, a clock. Nothing else
// is answered, so nothing can leave or enter but through takt.mjs.

const OK = 0, BAD_FILE = 8, EXISTS = 20, INVALID = 28, NOT_THERE = 44, NOT_KNOWN = 52;
const CREATE = 1, EXCLUSIVE = 4, TRUNCATE = 8;
const DEVICE = 2, FOLDER = 3, REGULAR = 4;
const ROOT = 3;

export function createSystem(module) {
  const folder = new Map(); // name: { bytes, length }
  const open = new Map(); // number: { file, at }
  const text = ["", "", ""];
  const decoder = new TextDecoder();
  let memory = null;
  let next = ROOT + 1;

  const view = () => new DataView(memory.buffer);
  const bytesAt = (at, length) => new Uint8Array(memory.buffer, at, length);

  function* pieces(vectors, count) {
    for (let i = 0; i < count; i++) yield bytesAt(view().getUint32(vectors + 8 * i, true), view().getUint32(vectors + 8 * i + 4, true));
  }

  function resize(file, length) {
    if (length > file.bytes.length) {
      const larger = new Uint8Array(Math.max(length, 2 * file.bytes.length, 4096));
      larger.set(file.bytes.subarray(0, file.length));
      file.bytes = larger;
    }
    if (length < file.length) file.bytes.fill(0, length, file.length);
    file.length = length;
  }

  function put(handle, piece) {
    const end = handle.at + piece.length;
    if (end > handle.file.length) resize(handle.file, end);
    handle.file.bytes.set(piece, handle.at);
    handle.at = end;
  }

  function take(handle, piece) {
    const found = handle.file.bytes.subarray(handle.at, Math.min(handle.at + piece.length, handle.file.length));
    piece.set(found);
    handle.at += found.length;
    return found.length;
  }

  function write(number, vectors, count, done) {
    let length = 0;
    for (const piece of pieces(vectors, count)) {
      if (number === 1 || number === 2) text[number] += decoder.decode(piece);
      else if (open.has(number)) put(open.get(number), piece);
      else return BAD_FILE;
      length += piece.length;
    }
    view().setUint32(done, length, true);
    return OK;
  }

  function read(handle, vectors, count, done) {
    let length = 0;
    for (const piece of pieces(vectors, count)) length += take(handle, piece);
    view().setUint32(done, length, true);
    return OK;
  }

  function status(number, at) {
    const handle = open.get(number);
    bytesAt(at, 64).fill(0);
    view().setUint8(at + 16, handle ? REGULAR : number === ROOT ? FOLDER : DEVICE);
    if (handle) view().setBigUint64(at + 32, BigInt(handle.file.length), true);
    return OK;
  }

  const calls = {
    args_sizes_get: (count, size) => (view().setUint32(count, 0, true), view().setUint32(size, 0, true), OK),
    args_get: () => OK,
    environ_sizes_get: (count, size) => (view().setUint32(count, 0, true), view().setUint32(size, 0, true), OK),
    environ_get: () => OK,
    clock_time_get: (clock, precision, at) => (view().setBigUint64(at, BigInt(Math.round((clock === 0 ? Date.now() : performance.now()) * 1e6)), true), OK),
    random_get: (at, length) => (bytesAt(at, length).fill(0), OK),
    sched_yield: () => OK,
    proc_exit: (code) => { throw new Error(`takt has ended with ${code}`); },
    fd_prestat_get: (number, at) => number === ROOT ? (view().setUint32(at, 0, true), view().setUint32(at + 4, 1, true), OK) : BAD_FILE,
    fd_prestat_dir_name: (number, at) => (bytesAt(at, 1).fill(47), OK),
    fd_fdstat_get(number, at) {
      if (number > ROOT && !open.has(number)) return BAD_FILE;
      bytesAt(at, 24).fill(0);
      view().setUint8(at, open.has(number) ? REGULAR : number === ROOT ? FOLDER : DEVICE);
      view().setBigUint64(at + 8, 0xffffffffffffffffn, true);
      view().setBigUint64(at + 16, 0xffffffffffffffffn, true);
      return OK;
    },
    fd_fdstat_set_flags: () => OK,
    fd_filestat_get: (number, at) => (number > ROOT && !open.has(number) ? BAD_FILE : status(number, at)),
    fd_filestat_set_size: (number, length) => (open.has(number) ? (resize(open.get(number).file, Number(length)), OK) : BAD_FILE),
    fd_sync: () => OK,
    fd_write: write,
    fd_read: (number, vectors, count, done) => open.has(number) ? read(open.get(number), vectors, count, done) : (view().setUint32(done, 0, true), OK),
    fd_pread: (number, vectors, count, at, done) => open.has(number) ? read({ file: open.get(number).file, at: Number(at) }, vectors, count, done) : BAD_FILE,
    fd_seek(number, offset, whence, at) {
      const handle = open.get(number);
      if (!handle) return 70;
      const to = Number(offset) + [0, handle.at, handle.file.length][whence];
      if (to < 0) return INVALID;
      handle.at = to;
      view().setBigUint64(at, BigInt(to), true);
      return OK;
    },
    fd_close: (number) => (open.delete(number) || number <= ROOT ? OK : BAD_FILE),
    path_open(number, look, at, length, flags, rights, inherited, state, result) {
      const name = decoder.decode(bytesAt(at, length));
      if (folder.has(name) ? flags & EXCLUSIVE : !(flags & CREATE)) return folder.has(name) ? EXISTS : NOT_THERE;
      const file = folder.get(name) ?? { bytes: new Uint8Array(0), length: 0 };
      if (flags & TRUNCATE) resize(file, 0);
      folder.set(name, file);
      open.set(next, { file, at: 0 });
      view().setUint32(result, next++, true);
      return OK;
    },
    path_unlink_file: (number, at, length) => (folder.delete(decoder.decode(bytesAt(at, length))) ? OK : NOT_THERE),
    path_filestat_get: () => NOT_THERE,
  };
  const imports = {};
  for (const { module: space, name } of WebAssembly.Module.imports(module)) {
    imports[space] ??= {};
    imports[space][name] = calls[name] ?? (() => NOT_KNOWN);
  }
  return { imports, text, begin: (instance) => { memory = instance.exports.memory; instance.exports._initialize?.(); } };
}
