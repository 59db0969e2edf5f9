// What the page of CNCjs does, without it: cncjs_client.cjs NODE_MODULES PORT. Each line of standard input is the arguments of an
// order to its server, as JSON; each line of standard output is what the server tells.

const { createRequire } = require("node:module");
const path = require("node:path");
const lines = require("node:readline");

const [modules, port] = process.argv.slice(2);
const io = createRequire(path.join(modules, "here.js"))("socket.io-client");
const TOLD = ["startup", "serialport:open", "serialport:error", "serialport:read", "workflow:state", "controller:state", "controller:settings", "sender:status"];

async function main() {
  const headers = { "content-type": "application/json" };
  const { token } = await (await fetch(`http://127.0.0.1:${port}/api/signin`, { method: "POST", headers, body: "{}" })).json();
  const socket = io(`http://127.0.0.1:${port}`, { query: `token=${token}`, transports: ["websocket"] });
  for (const name of TOLD) socket.on(name, (...data) => process.stdout.write(`${JSON.stringify([name, ...data])}\n`));
  lines.createInterface({ input: process.stdin }).on("line", (line) => socket.emit(...JSON.parse(line))).on("close", () => process.exit(0));
}

main();
