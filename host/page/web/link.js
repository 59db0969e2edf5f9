// The connection to the service: frames in, orders out. Opens itself again when it is lost.

const orders = new Map();
const listeners = new Map();
let socket = null;
let last = 0;

export const link = { open: false, bytes: 0 };

// hear(name, function): name is a key of a message ("hello", "tables"), "open", "lost", "frame": each, or "draw": the last
// one before the screen is drawn, so that a slow screen falls behind in pictures and not in time.
export function hear(name, listener) {
  listeners.set(name, [...(listeners.get(name) || []), listener]);
}

function tell(name, value) {
  for (const listener of listeners.get(name) || []) listener(value);
}

let newest = null;

function draw() {
  const frame = newest;
  newest = null;
  tell("draw", frame);
}

function takeFrame(frame) {
  if (!newest) requestAnimationFrame(draw);
  newest = frame;
  tell("frame", frame);
}

function take(message) {
  if ("n" in message) return takeFrame(message);
  if (!("reply" in message)) {
    for (const name of Object.keys(message)) if (listeners.has(name)) return tell(name, message);
    return undefined;
  }
  const done = orders.get(message.reply);
  orders.delete(message.reply);
  return done && done(message.refused);
}

function lose() {
  link.open = false;
  for (const done of orders.values()) done("the connection is lost");
  orders.clear();
  tell("lost");
  setTimeout(connect, 500);
}

export function connect() {
  socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`, "takt");
  socket.onopen = () => { link.open = true; tell("open"); };
  socket.onmessage = (event) => { link.bytes += event.data.length; take(JSON.parse(event.data)); };
  socket.onclose = lose;
}

export function send(message) {
  if (link.open) socket.send(typeof message === "string" || message instanceof Uint8Array ? message : JSON.stringify(message));
}

export function backlog() {
  return link.open ? socket.bufferedAmount : 0;
}

// Resolves to the refusal, "" when it is done.
export function order(message) {
  if (!link.open) return Promise.resolve("there is no connection");
  last += 1;
  const id = last;
  return new Promise((done) => {
    orders.set(id, done);
    send({ ...message, id });
  });
}

// write(["MODE", 1], ["CYCLE_START", 1]): registers in counts, in this order.
export function write(...pairs) {
  return order({ write: pairs });
}
