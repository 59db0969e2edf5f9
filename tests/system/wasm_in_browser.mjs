// Drives the try-it page in a headless Chromium, from a file and without a network: wasm_in_browser.mjs PAGE PROGRAM DIGEST
//
// Prints how long the page took, in seconds. Each step says a claim; the first that does not hold ends it.

import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import { basename } from "node:path";

const { chromium } = createRequire(process.env.PLAYWRIGHT)("playwright-core");
const [url, program, digest] = process.argv.slice(2);
const OPTIONS = ["--headless", "--no-sandbox", "--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: OPTIONS });
const context = await browser.newContext({ offline: true, viewport: { width: 1200, height: 900 } });
const page = await context.newPage();
const mistakes = [];
const asked = [];
page.setDefaultTimeout(Number(process.env.PATIENCE_MS || 200000));
page.on("pageerror", (error) => mistakes.push(error.stack));
page.on("console", (message) => { if (message.type() === "error") mistakes.push(message.text()); });
page.on("request", (request) => { if (!/^(file|blob|data):/.test(request.url())) asked.push(request.url()); });

function check(condition, claim, detail = "") {
  if (!condition) throw new Error(`${claim} ${detail}`);
}

async function drop(name, text) {
  const transfer = await page.evaluateHandle(([n, t]) => { const data = new DataTransfer(); data.items.add(new File([t], n)); return data; }, [name, text]);
  await page.evaluate(() => { window.takt.result = null; });
  await page.dispatchEvent("body", "drop", { dataTransfer: transfer });
  await page.waitForFunction(() => window.takt.result !== null);
}

const figure = (name) => page.textContent(`#figure-${name}`);
const steps = {
  async "a program that is dropped is judged: time, limits and digest are the command's"() {
    await drop(basename(program), readFileSync(program, "utf8"));
    check(await figure("digest") === digest, "the digest", await figure("digest"));
    check(/^(\d+) of \1 held$/.test(await figure("checks")), "all checks hold", await figure("checks"));
    check(await page.evaluate(() => document.querySelectorAll("#axes tr").length) >= 4, "axes beside their limits");
    console.log((await figure("judged-here-in")).split(" ")[0]);
  },
  async "its path is drawn, and turns"() {
    await page.waitForFunction(() => Number(document.getElementById("path").dataset.points) > 10);
    const picture = () => page.evaluate(() => document.getElementById("path").toDataURL().length);
    const before = await page.evaluate(() => document.getElementById("path").toDataURL());
    check(await picture() > 3000, "there is a picture");
    const box = await page.locator("#path").boundingBox();
    await page.mouse.move(box.x + 200, box.y + 200);
    await page.mouse.down();
    await page.mouse.move(box.x + 300, box.y + 240, { steps: 4 });
    await page.mouse.up();
    await page.waitForFunction((old) => document.getElementById("path").toDataURL() !== old, before);
  },
  async "the report opens in the page, with its charts"() {
    await page.click("#show");
    const frame = page.frameLocator("#report");
    await frame.locator("html[data-ready='true']").waitFor({ state: "attached" });
    check(await frame.locator("#axes tr").count() >= 4, "its axes");
    if (await page.evaluate(() => document.getElementById("plotting").textContent.length > 10)) await frame.locator("#chart-list .plot").first().waitFor();
  },
  async "a machine that is dropped beside it counts"() {
    await drop("mill.ini", "[axis X]\nmax_jerk_mm_s3 = 20000\n[axis Y]\n[axis Z]\n");
    check(await figure("digest") !== digest, "the digest is another");
  },
  async "an error names line and column"() {
    await drop("wrong.ngc", "G21 G90\nG1 F100 X1 Q\nM2\n");
    check(/wrong\.ngc:2:\d+: error/.test(await page.textContent("#messages")), "the message", await page.textContent("#messages"));
    check(await page.isHidden("#result"), "and no result");
  },
  async "a run can be stopped, and the page goes on"() {
    const transfer = await page.evaluateHandle(() => { const data = new DataTransfer(); data.items.add(new File(["G21 G90\nG1 F1 X90\nX0\nM2\n"], "slow.ngc")); return data; });
    await page.dispatchEvent("body", "drop", { dataTransfer: transfer });
    await page.waitForFunction(() => document.getElementById("state").textContent.includes("of the machine"));
    await page.click("#stop");
    check(await page.textContent("#state") === "stopped", "it says so");
    await page.click("#example");
    await page.waitForFunction(() => document.getElementById("figure-outcome")?.textContent === "completed" && window.takt.result !== null);
  },
};

let claim = "the page opens";
try {
  await page.goto(url);
  await page.waitForFunction(() => window.takt.warm);
  for (const [name, step] of Object.entries(steps)) {
    claim = name;
    await step();
  }
  claim = "nothing went wrong on the way, and nothing was asked of a network";
  check(mistakes.length === 0, mistakes.join("\n"));
  check(asked.length === 0, asked.join("\n"));
} catch (error) {
  console.error(`${claim}: ${error.message}\n${mistakes.join("\n")}`);
  process.exitCode = 1;
}
await browser.close();
