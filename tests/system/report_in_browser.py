#!/usr/bin/env python3
"""Opens reports in headless Chromium and reads back what is on the page.

    report_in_browser.py REPORT_SAMPLE

REPORT_SAMPLE writes a report of a made-up run. The page must draw every plot with the number of points the run
has, load nothing, make no error, keep the time axes of all charts together, and work without the plotting library.

Exit status: 0 all held, 1 something did not, 77 there is no Chromium or no plotting library.
"""
import html
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
CYCLES = 3000
BROWSERS = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"]
# WebGL is drawn by software, so that no graphics card is needed.
OPTIONS = [
    "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
    "--disable-background-networking", "--disable-dev-shm-usage", "--no-first-run",
    "--host-resolver-rules=MAP * ~NOTFOUND", "--window-size=1200,1600", "--virtual-time-budget=60000", "--dump-dom",
]
HANGS_AFTER_S = 300

# Velocity needs one cycle before, acceleration two, jerk three, and a drive answers after three.
LINEAR = {"velocity": CYCLES - 1, "acceleration": CYCLES - 2, "jerk": CYCLES - 3, "following": CYCLES - 3}
EXPECTED = {"chart-feed": f"feed:{CYCLES}", "chart-override": f"override:{CYCLES}"}
for quantity, points in LINEAR.items():
    EXPECTED[f"chart-{quantity}-linear"] = " ".join(f"{axis}:{points}" for axis in "XYZ")
    EXPECTED[f"chart-{quantity}-rotary"] = f"A:{points}"

# Uses the page as a reader would, and writes down on it what came of that.
PROBE = """
(async () => {
  const page = document.documentElement;
  const pause = (ms) => new Promise((done) => setTimeout(done, ms));
  while (!page.dataset.ready) await pause(20);
  const plots = [...document.querySelectorAll("#chart-list .plot")];
  const scene = document.getElementById("path-plot");
  page.dataset.pathTraces = (scene.data || []).map((trace) => trace.name + ":" + trace.x.length).join(" ");
  if (plots.length > 0) {
    await Plotly.relayout(plots[3], { "xaxis.range[0]": 1, "xaxis.range[1]": 2 });
    page.dataset.windows = [...new Set(plots.map((plot) => plot.layout.xaxis.range.join(" ")))].join(", ");
    const box = plots[0].getBoundingClientRect();
    plots[0].dispatchEvent(new PointerEvent("pointermove", { clientX: box.left + box.width / 2, bubbles: true }));
    page.dataset.readout = document.getElementById("readout").textContent;
    plots[0].dispatchEvent(new KeyboardEvent("keydown", { key: "0", bubbles: true }));
    page.dataset.whole = plots[5].layout.xaxis.range.join(" ");
    const limits = () => plots.find((plot) => plot.id === "chart-jerk-linear").layout.shapes.length;
    const before = limits();
    const switches = document.querySelectorAll("#axis-switches button");
    switches[0].click();
    switches[2].click();
    document.querySelector('[data-theme-choice="dark"]').click();
    document.getElementById("path-colour").value = "time";
    document.getElementById("path-colour").dispatchEvent(new Event("change"));
    await pause(200);
    page.dataset.hidden = plots.map((plot) => plot.data.filter((trace) => trace.visible === false).length).join("");
    page.dataset.limits = before + " " + limits();
    page.dataset.dark = String(plots[0].layout.font.color !== "" && page.dataset.theme === "dark");
    dispatchEvent(new Event("beforeprint"));
    page.dataset.picture = String(scene.querySelector("img.on-paper").src.startsWith("data:image/png"));
    dispatchEvent(new Event("afterprint"));
    await pause(200);
  }
  page.dataset.shares = [...document.querySelectorAll("#shares-section .share-text, #shares-section p")].map((text) => text.textContent).join("|");
  page.dataset.probed = "true";
})();
"""

failures = []


def check(what, held, seen):
    if not held:
        failures.append(f"{what}: {seen}")


def find_browser():
    for name in BROWSERS:
        if shutil.which(name):
            return name
    print("no Chromium is installed")
    sys.exit(SKIPPED)


def open_page(browser, page):
    """The page after its scripts have run, as text."""
    with tempfile.TemporaryDirectory() as profile:
        command = [browser, *OPTIONS, f"--user-data-dir={profile}", page.resolve().as_uri()]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=HANGS_AFTER_S,
                              check=False)
    return done.stdout.decode("utf-8", "replace")


def attributes(tag):
    return {name: html.unescape(value) for name, value in re.findall(r'([\w-]+)="([^"]*)"', tag)}


def root_of(dom):
    found = re.search(r"<html[^>]*>", dom)
    return attributes(found.group(0)) if found else {}


def check_common(name, root):
    check(f"{name}: the page gets ready", root.get("data-ready") == "true" and root.get("data-probed") == "true", root)
    check(f"{name}: no error", "data-errors" not in root, root.get("data-errors"))
    check(f"{name}: nothing is loaded", root.get("data-resources") == "0", root.get("data-resources"))


def check_tables(name, dom):
    check(f"{name}: title", "<title>spiral &lt;pocket&gt; \"A\".ngc on demo mill – completed</title>" in dom, "")
    check(f"{name}: broken check", "Check jerk.Z is broken: 61,000, limit 60,000" in dom, "")
    for table, rows in {"axes": 4, "checks": 5}.items():
        body = re.search(rf'<table id="{table}">.*?<tbody>(.*?)</tbody>', dom, re.S)
        seen = body.group(1).count("<tr>") if body else 0
        check(f"{name}: rows of table {table}", seen == rows, seen)
    check(f"{name}: text of the summary stays text", "9f86d081884c7d65&lt;/script&gt;&lt;b&gt;" in dom, "")


def check_shares(name, root):
    wanted = ("velocity|10 %|40 %", "acceleration|20 %|50 %", "jerk|0 %|25 %", "on board, 2.000 s", "ahead, 1.500 s")
    seen = root.get("data-shares", "")
    check(f"{name}: shares of the time at each limit", all(text in seen for text in wanted), seen)


def check_plots(dom, root):
    plots = {plot["id"]: plot for plot in map(attributes, re.findall(r"<div[^>]*data-points=[^>]*>", dom))}
    for name, points in EXPECTED.items():
        seen = plots.get(name, {}).get("data-points")
        check(f"points of {name}", seen == points, seen)
    check("charts", set(plots) == {*EXPECTED, "path-plot"}, sorted(plots))
    check("points of the path", re.fullmatch(r"path:[1-9]\d{2,}", plots.get("path-plot", {}).get("data-points", "")),
          plots.get("path-plot"))
    check("traces of the path", re.match(r"feed:\d{3,} rapid:\d{2,} start:1 end:1 cursor:1$",
                                         root.get("data-path-traces", "")), root.get("data-path-traces"))
    check("WebGL draws the path", "<canvas" in dom, "no canvas")


def check_use(root):
    check("zooming one chart zooms all", root.get("data-windows") == "1 2", root.get("data-windows"))
    check("the key 0 shows the whole run", root.get("data-whole") == f"0 {(CYCLES - 1) / 1000}", root.get("data-whole"))
    check("the cursor tells time, line and place",
          re.match(r"1\.\d{3} s · line 14 · X [−\d.]+ +Y [−\d.]+ +Z [−\d.]+ · [\d,.]+ mm/min$",
                   root.get("data-readout", "")), root.get("data-readout"))
    hidden = "".join("2" if name.endswith("linear") else "0" for name in EXPECTED)
    check("axes switched off are hidden in their charts", root.get("data-hidden") == hidden, root.get("data-hidden"))
    check("limit lines of the axes shown", root.get("data-limits") == "4 2", root.get("data-limits"))
    check("dark colours", root.get("data-dark") == "true", root.get("data-dark"))
    check("the path can be printed", root.get("data-picture") == "true", root.get("data-picture"))


def main():
    browser = find_browser()
    page = pathlib.Path("report.html")
    subprocess.run([sys.argv[1], str(CYCLES), str(page)], check=True)
    text = page.read_text(encoding="utf-8").replace("</body>", f"<script>{PROBE}</script></body>")
    has_library = "window.Plotly = Plotly" in text
    if has_library:
        page.write_text(text, encoding="utf-8")
        dom = open_page(browser, page)
        root = root_of(dom)
        check_common("with plots", root)
        check_tables("with plots", dom)
        check_plots(dom, root)
        check_use(root)

    bare = pathlib.Path("report_bare.html")
    bare.write_text(re.sub(r"<script>/\*\*\s.*?</script>", "", text, count=1, flags=re.S), encoding="utf-8")
    dom = open_page(browser, bare)
    check_common("without plots", root_of(dom))
    check_tables("without plots", dom)
    check_shares("without plots", root_of(dom))
    check("without plots: the page says so", "Plots are missing" in dom.split("<script")[0], "")

    if failures:
        print("\n".join(failures))
        return 1
    print("every plot is there" if has_library else "built without the plotting library: only the tables were checked")
    return 0 if has_library else SKIPPED


if __name__ == "__main__":
    sys.exit(main())
