// Drives the page in a headless Chromium as an operator does, by Playwright: page_in_browser.mjs URL [FOLDER]
//
// Each step says a claim; the first that does not hold ends it. FOLDER: screenshots at three sizes go there.

import { createRequire } from "node:module";
import { readFileSync } from "node:fs";

const { chromium } = createRequire(process.env.PLAYWRIGHT)("playwright-core");
const [url, folder] = process.argv.slice(2);
const OPTIONS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const SIZES = { phone: [390, 844, "light"], tablet: [1024, 768, "dark"], wide: [1720, 980, "light"] };
const PROGRAM = readFileSync(process.env.TAKT_PART);

const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: OPTIONS });
const mistakes = [];

// A page gives signs of life while a button is held. On a busy computer one of them may come later than its watchdog, and the
// axis stops with an alarm, as it should; so the watchdog is long but where its end is what is tried.
function makePatient() {
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function (message) { return send.call(this, typeof message === "string" ? message.replace(/\["WATCHDOG",[1-9]\d*\]/, '["WATCHDOG",60000]') : message); };
}

async function open(size, watchdog = makePatient) {
  const [width, height, colorScheme] = SIZES[size];
  const page = await (await browser.newContext({ viewport: { width, height }, colorScheme, hasTouch: size === "phone" })).newPage();
  page.setDefaultTimeout(Number(process.env.PATIENCE_MS || 60000));
  await page.addInitScript(watchdog);
  page.on("pageerror", (error) => mistakes.push(error.stack));
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) mistakes.push(message.text()); });
  await page.goto(url);
  await page.waitForFunction(() => window.takt?.machine.frame && window.takt.machine.hello);
  return page;
}

const state = (page, wanted) => page.waitForFunction((text) => document.getElementById("state").textContent.startsWith(text), wanted);
const tab = (page, title) => page.getByRole("tab", { name: title, exact: true }).click();
const value = (page, name) => page.evaluate((register) => window.takt.value(register), name);
const until = (page, name, low, high) => page.waitForFunction(([n, a, b]) => { const v = window.takt.value(n); return v >= a && v <= b; }, [name, low, high]);

function check(condition, claim, detail = "") {
  if (!condition) throw new Error(`${claim} ${detail}`);
}

async function drop(page, name, bytes) {
  const transfer = await page.evaluateHandle(([n, text]) => { const data = new DataTransfer(); data.items.add(new File([text], n)); return data; }, [name, bytes.toString()]);
  await page.dispatchEvent("body", "drop", { dataTransfer: transfer });
  await page.waitForFunction((size) => window.takt.counts("PROGRAM_SIZE") === size, bytes.length);
}

// It is refused, which the page says, while drives brake: then again.
async function reset(page) {
  for (;;) {
    await page.evaluate(() => { document.getElementById("message").textContent = ""; });
    await page.click("#reset");
    const came = await page.waitForFunction(() => {
      const text = (id) => document.getElementById(id).textContent;
      const isIdle = text("state").startsWith("idle") && window.takt.counts("ALARM") === 0;
      return text("message").startsWith("Reset: ") ? "refused" : isIdle && "idle";
    });
    if (await came.jsonValue() === "idle") return;
  }
}

// The page's own watchdog is short: a busy computer may end the jog, with an alarm, before it is at its feed. Then again.
async function jogAsThePageDoes(page, other) {
  for (;;) {
    await other.mouse.down();
    const jogs = await page.waitForFunction(() => (window.takt.value("AXIS_FEED_X") >= 100 ? "jogs" : window.takt.counts("ALARM") !== 0 && "alarm"));
    if (await jogs.jsonValue() === "jogs") return;
    await other.mouse.up();
    await reset(page);
  }
}

const steps = {
  async "a program that is dropped is loaded, shown and drawn"(page) {
    await drop(page, "part.ngc", PROGRAM);
    await page.waitForFunction(() => document.querySelectorAll("#text .line").length > 5 && Number(document.getElementById("view").dataset.points) > 10);
    check((await page.textContent("#text .line")).length > 0, "its first line is shown");
  },
  async "it starts, holds, goes on and ends, and its active line is shown"(page) {
    await page.click("#start");
    await state(page, "running");
    await page.waitForSelector("#text .line.active");
    await page.click("#hold");
    await state(page, "held: operator");
    await until(page, "FEED", 0, 0);
    await page.click("#resume");
    await state(page, "running");
    await page.keyboard.press("Escape");
    await state(page, "held: operator");
    await page.click("#start");
    await state(page, "idle");
    check(await value(page, "OUTCOME") === 1, "completed");
  },
  async "single block holds after each block; reset gives it up"(page) {
    await page.check("#single");
    await page.click("#start");
    await state(page, "held: single block");
    await page.click("#resume");
    await state(page, "held: single block");
    await reset(page);
    await page.uncheck("#single");
  },
  async "from a line that is clicked"(page) {
    await page.waitForFunction(() => !document.getElementById("single").checked && window.takt.counts("SINGLE_BLOCK") === 0);
    await page.locator("#text .line[data-n='6']").click();
    check(await page.inputValue("#fromline") === "6", "the line is taken");
    await page.click("#start");
    await state(page, "running");
    await state(page, "idle");
    await page.fill("#fromline", "0");
  },
  async "overrides follow their sliders"(page) {
    await page.locator("#FEED_OVERRIDE").fill("50");
    await until(page, "FEED_OVERRIDE", 50, 50);
    await page.getByRole("button", { name: "Feed override 100 %" }).click();
    await until(page, "FEED_OVERRIDE", 100, 100);
    await page.locator("#SPINDLE_OVERRIDE").fill("120");
    await until(page, "SPINDLE_OVERRIDE", 120, 120);
    await page.locator("#RAPID_OVERRIDE").fill("30");
    await until(page, "RAPID_OVERRIDE", 30, 30);
    await page.locator("#RAPID_OVERRIDE").fill("100");
  },
  async "lines by hand, with a history"(page) {
    await tab(page, "MDI");
    await page.fill("#mdiline", "G0 X0 Y0 Z0");
    await page.keyboard.press("Enter");
    await until(page, "POSITION_Z", 0, 0); // the program has ended at Z 1
    await state(page, "idle");
    await page.waitForFunction(() => document.getElementById("mdiline").value === "");
    await page.press("#mdiline", "ArrowUp");
    check(await page.inputValue("#mdiline") === "G0 X0 Y0 Z0", "the last one comes back");
    await page.fill("#mdiline", "G0 X1 Y2");
    await page.keyboard.press("Enter");
    await until(page, "POSITION_Y", 2, 2);
    await state(page, "idle");
    await page.fill("#mdiline", "G0 Q7");
    await page.keyboard.press("Enter");
    await page.waitForSelector("#alarm:not([hidden])");
    check((await page.textContent("#alarmtext")).includes("program"), "a wrong one raises an alarm");
    await reset(page);
    await page.waitForSelector("#alarm", { state: "hidden" });
    await tab(page, "Alarms");
    check(await page.locator("#alarms li").count() === 1, "alarms have a history");
  },
  async "steps, and jogging as long as a button is held"(page) {
    await state(page, "idle");
    await tab(page, "Jog");
    await page.selectOption("#jogstep", "1");
    await page.click("[data-jog='X+']");
    await until(page, "POSITION_X", 2, 2);
    await state(page, "idle");
    await page.selectOption("#jogstep", "0");
    await page.fill("#jogfeed", "600");
    const box = await page.locator("[data-jog='Y+']").boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await state(page, "jogging");
    await until(page, "POSITION_Y", 3, 1000);
    await page.mouse.up();
    await state(page, "idle");
    await until(page, "WATCHDOG", 0, 0);
    check(await value(page, "ALARM") === 0, "no alarm");
  },
  async "jogging by key as long as it is held"(page) {
    await page.check("#jogkeys");
    const before = await value(page, "POSITION_Z");
    await page.keyboard.down("PageUp");
    await until(page, "POSITION_Z", before + 0.5, 1000);
    await page.keyboard.up("PageUp");
    await state(page, "idle");
    await page.uncheck("#jogkeys");
  },
  async "a finger on a phone jogs until it is lifted"(page) {
    const other = await open("phone");
    await tab(other, "Jog");
    const button = other.locator("[data-jog='Y+']"), touches = await other.context().newCDPSession(other);
    await button.scrollIntoViewIfNeeded();
    const place = await button.boundingBox(), before = await value(page, "POSITION_Y");
    const finger = { x: place.x + place.width / 2, y: place.y + place.height / 2 };
    await touches.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: [finger] });
    await until(page, "POSITION_Y", before + 0.5, 1000);
    await touches.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
    await state(page, "idle");
    check(await other.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "nothing is wider than the phone");
    for (const title of ["Offsets", "Tools"]) {
      await tab(other, title);
      const box = other.locator("[role=tabpanel]:not([hidden]) .scroll");
      check(await box.evaluate((table) => table.scrollWidth <= table.clientWidth), `${title} are as wide as the phone`);
    }
    await other.context().close();
    check(await value(page, "ALARM") === 0, "no alarm");
  },
  async "homing"(page) {
    await page.click("#home");
    await state(page, "homing");
    await state(page, "idle");
    await until(page, "POSITION_X", 0, 0);
  },
  async "work offsets, touch-off and tools"(page) {
    await tab(page, "Offsets");
    const cell = page.getByLabel("G55 Y");
    await cell.fill("12.5");
    await cell.press("Enter");
    await page.waitForFunction(() => window.takt.counts("WORK_SYSTEM") === 2 && window.takt.value("WORK_OFFSET_Y") === 12.5);
    await page.getByLabel("work position", { exact: true }).fill("7");
    await page.click("#touchoff");
    await until(page, "WORK_POSITION_X", 7, 7);
    await page.getByLabel("work position", { exact: true }).fill("0");
    await page.click("#touchoff");
    await until(page, "WORK_POSITION_X", 0, 0);
    await tab(page, "Tools");
    const length = page.getByLabel("tool 1 length");
    await length.fill("33.25");
    await length.press("Enter");
    await page.waitForFunction(() => window.takt.counts("TOOL_SELECT") === 1 && window.takt.value("TOOL_OFFSET_Z") === 33.25);
  },
  async "each axis against its limits, the bus, and a drive's dictionary"(page) {
    await tab(page, "Axes");
    await page.click("#start");
    await page.waitForFunction(() => [...document.querySelectorAll(".chart b")].some((b) => parseFloat(b.textContent) > 100));
    await state(page, "idle");
    check(await page.locator(".chart").count() === 12, "four charts an axis");
    check(await page.locator(".chart .over").count() === 0, "none beyond its limit");
    await tab(page, "Bus");
    await page.waitForSelector("#bus meter");
    check((await page.textContent("#bus")).includes("RPDO2 of node 1"), "response times");
    await tab(page, "Drives");
    await page.waitForFunction(() => document.querySelectorAll("#objects tr").length > 80);
    await page.fill("#objectfilter", "statusword");
    await page.waitForFunction(() => [...document.querySelectorAll("#objects tr:not([hidden])")].some((row) => (Number(row.lastElementChild.textContent) & 0x6F) === 0x27));
    check((await page.textContent("#drivestates")).includes("operation enabled"), "drives' states");
    await page.fill("#objectfilter", "");
  },
  async "faults by a click, and the way back"(page) {
    await tab(page, "Faults");
    await page.getByRole("button", { name: "Overheats" }).first().click();
    await state(page, "alarm");
    await page.waitForSelector("#alarm:not([hidden])");
    await page.waitForSelector("#inforce li");
    await reset(page);
    await page.fill("#faultline", "drive 1 nonsense");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => document.getElementById("message").textContent.includes("nonsense"));
  },
  async "the emergency stop by key and button, for a page that is not in control too"(page) {
    const other = await open("phone");
    await page.click("#claim");
    await page.waitForFunction(() => document.getElementById("control").textContent.includes("you are"));
    await other.waitForFunction(() => document.getElementById("control").textContent.includes("another"));
    await other.locator("#FEED_OVERRIDE").fill("50");
    await other.waitForFunction(() => document.getElementById("message").textContent.includes("another panel has control"));
    await other.click("#estop");
    await state(page, "emergency stop");
    await page.click("#estop");
    await until(page, "EMERGENCY_STOP", 0, 0);
    await reset(page);
    await page.click("#claim");
    await until(page, "WATCHDOG", 0, 0);
    await page.keyboard.press("Control+Space");
    await state(other, "emergency stop");
    await page.click("#estop");
    await until(page, "EMERGENCY_STOP", 0, 0);
    await reset(page);
    await other.context().close();
  },
  async "a page that is gone while it jogs leaves the axis at rest"(page) {
    const other = await open("wide", () => {});
    await tab(other, "Jog");
    const box = await other.locator("[data-jog='X+']").boundingBox();
    await other.mouse.move(box.x + 5, box.y + 5);
    await jogAsThePageDoes(page, other);
    await other.context().close();
    await until(page, "AXIS_FEED_X", 0, 0);
    await page.waitForFunction(() => [1, 6].includes(window.takt.counts("STATE")));
    await reset(page);
  },
  async "everything is reached by keyboard alone"(page) {
    await page.evaluate(() => document.activeElement.blur());
    const seen = new Set();
    for (let i = 0; i < 60 && !seen.has("estop tab"); i += 1) {
      await page.keyboard.press("Tab");
      seen.add(await page.evaluate(() => document.activeElement.id || document.activeElement.getAttribute("role") || document.activeElement.tagName));
    }
    for (const id of ["estop", "claim", "view", "start", "hold", "file", "text", "tab", "FEED_OVERRIDE"]) check(seen.has(id) || id === "hold", `the key Tab reaches ${id}`, [...seen].join(" "));
  },
};

async function shoot(size, title, then) {
  const page = await open(size);
  await tab(page, title);
  await page.click("#start");
  await then(page);
  await page.waitForTimeout(2500);
  await page.screenshot({ path: `${folder}/page-${size}.png` });
  await page.keyboard.press("Escape");
  await state(page, "held");
  await reset(page);
  await page.context().close();
}

let status = 0;
try {
  const page = await open("tablet");
  for (const [claim, step] of Object.entries(steps)) {
    process.stderr.write(`${claim}\n`);
    await step(page);
  }
  const ages = await page.evaluate(() => window.takt.glass.ages.slice().sort((a, b) => a - b));
  console.log(`glass to glass: 95 % within ${ages[Math.floor(0.95 * ages.length)].toFixed(1)} ms of ${ages.length} frames`);
  if (folder) {
    await drop(page, "engraving.ngc", readFileSync(process.env.TAKT_SHOWN));
    for (const [size, title] of [["phone", "Jog"], ["tablet", "Offsets"], ["wide", "Axes"]]) await shoot(size, title, async () => {});
  }
  check(mistakes.length === 0, "no errors on the page", mistakes.join("\n"));
} catch (error) {
  console.log(`FAILED: ${error.stack}\n${mistakes.join("\n")}`);
  status = 1;
}
await browser.close();
process.exit(status);
