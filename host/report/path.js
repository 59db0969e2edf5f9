"use strict";
/* The tool path in space. */

const pathColumns = ["X", "Y", "Z"];
/* Size of the box that fills a frame of this width for one of height, from most sides. */
const pathFill = { size: 1.8, width: 1.35 };
/* Width of the colour bar. */
const pathBar_px = 100;
const pathPrint = { width: 650, height: 480 };
const pathView = { zoom: 1 };
/* Of the traces in the order of pathTraces. */
const markIndex = 4;
/* Directions of the eye; the length does not matter in an orthographic view. */
const pathEyes = {
  iso: { eye: { x: 1.1, y: -1.5, z: 1.1 }, up: { x: 0, y: 0, z: 1 } },
  top: { eye: { x: 0, y: 0, z: 2 }, up: { x: 0, y: 1, z: 0 } },
  front: { eye: { x: 0, y: -2, z: 0 }, up: { x: 0, y: 0, z: 1 } },
  right: { eye: { x: 2, y: 0, z: 0 }, up: { x: 0, y: 0, z: 1 } },
};
/* Dark to light blue-green-yellow, told apart without red against green; the end that drowns in the page is left out. */
const pathScales = {
  light: [[0, "#440154"], [0.25, "#3d4d8a"], [0.5, "#277f8e"], [0.75, "#35a86f"], [1, "#b5c022"]],
  dark: [[0, "#5d6bd0"], [0.25, "#3f93b8"], [0.5, "#2fb59a"], [0.75, "#79d151"], [1, "#fde725"]],
};

function decodePath() {
  const path = { count: runData.path.count };
  for (const name of ["cycle", "line"]) path[name] = decodeColumn(runData.path[name], Uint32Array);
  for (const name of ["feed", ...pathColumns]) path[name] = decodeColumn(runData.path[name], Float32Array);
  path.rapid = decodeColumn(runData.path.rapid, Uint8Array);
  return path;
}

/* Points of all ways of one kind in a row, with a gap where another kind comes between. */
function collectWays(path, rapid) {
  const index = [];
  for (let k = 1; k < path.count; k++) {
    if (Boolean(path.rapid[k]) !== rapid) continue;
    if (index[index.length - 1] !== k - 1) index.push(-1, k - 1);
    index.push(k);
  }
  return index;
}

function pick(column, index) {
  return index.map((k) => (k < 0 ? null : column[k]));
}

function colourValues(path, index) {
  const by = document.getElementById("path-colour").value;
  const values = pick(by === "time" ? path.cycle : path[by], index).map((value) => value || 0);
  return by === "time" ? values.map((cycle) => cycle * runData.cycle_s) : values;
}

function pathScale() {
  return pathScales[document.documentElement.dataset.theme === "dark" ? "dark" : "light"];
}

function wayTrace(path, index, name, line) {
  return {
    type: "scatter3d", mode: "lines", name, showlegend: false, connectgaps: false, line,
    x: pick(path.X, index), y: pick(path.Y, index), z: pick(path.Z, index),
    customdata: index.map((k) => (k < 0 ? null : [path.line[k], path.cycle[k] * runData.cycle_s, path.feed[k]])),
    hovertemplate: "X %{x:.3f}  Y %{y:.3f}  Z %{z:.3f} mm<br>line %{customdata[0]}, %{customdata[1]:.3f} s, "
      + "%{customdata[2]:,.0f} mm/min<extra></extra>",
  };
}

function markTrace(name, k, colour, symbol, size) {
  const at = k === null ? [[null], [null], [null]] : pathColumns.map((axis) => [pathView.path[axis][k]]);
  return { type: "scatter3d", mode: "markers", name, x: at[0], y: at[1], z: at[2], showlegend: k !== null, hoverinfo: k === null ? "skip" : "name",
    marker: { color: cssColour(colour), size, symbol, line: { color: cssColour("--card"), width: 1 } } };
}

const colourTitles = { feed: "path feed<br>in mm/min", line: "program<br>line", time: "time in s" };

function pathTraces() {
  const { path } = pathView;
  const by = document.getElementById("path-colour").value;
  const [text, rapid] = ["--soft", "--rapid"].map(cssColour);
  const feeds = collectWays(path, false);
  const coloured = { width: 5, color: colourValues(path, feeds), colorscale: pathScale(), showscale: true,
    colorbar: { title: { text: colourTitles[by], side: "top" }, thickness: 14, len: 0.75, outlinewidth: 0, tickfont: { color: text },
      x: 1, xpad: 4, exponentformat: "none", separatethousands: true } };
  if (feeds.length === 0) delete coloured.color;
  const rapids = { ...wayTrace(path, collectWays(path, true), "rapid", { width: 3, color: rapid, dash: "dot" }), showlegend: true,
    visible: document.getElementById("path-rapids").checked };
  return [wayTrace(path, feeds, "feed", coloured), rapids,
    markTrace("start", 0, "--good", "circle", 6), markTrace("end", path.count - 1, "--bad", "square", 5),
    markTrace("cursor", null, "--accent", "circle", 7)];
}

/* Equal scales on all axes: ranges with some air, and the box in their proportion. */
function pathRanges() {
  const extents = pathColumns.map((axis) => {
    const column = pathView.path[axis];
    return column.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
  });
  const air = 0.04 * Math.max(...extents.map(([low, high]) => high - low)) || 1;
  return extents.map(([low, high]) => [low - air, high + air]);
}

function pathAspect() {
  const lengths = pathView.ranges.map(([low, high]) => high - low);
  const { clientWidth, clientHeight } = pathView.plot;
  const [width, height] = timeView.printing ? [pathPrint.width, pathPrint.height] : [clientWidth, clientHeight];
  const frame = (width - pathBar_px) / height;
  const scale = (pathView.zoom * pathFill.size * Math.min(1, frame / pathFill.width)) / Math.max(...lengths);
  return { x: lengths[0] * scale, y: lengths[1] * scale, z: lengths[2] * scale };
}

function pathLayout() {
  const [text, grid, line] = ["--soft", "--line", "--soft"].map(cssColour);
  const scene = { aspectmode: "manual", aspectratio: pathAspect(), dragmode: "turntable",
    camera: { ...pathEyes.iso, center: { x: 0, y: 0, z: 0 }, projection: { type: "orthographic" } } };
  pathColumns.forEach((axis, i) => {
    scene[`${axis.toLowerCase()}axis`] = { title: { text: `${axis} in mm` }, range: pathView.ranges[i], gridcolor: grid, linecolor: line,
      zerolinecolor: grid, showbackground: false, showspikes: false, nticks: 6, color: text };
  });
  return {
    ...printSize(pathPrint), margin: { l: 0, r: 0, t: 0, b: 0 }, paper_bgcolor: "rgba(0,0,0,0)", scene, uirevision: "kept", modebar: modebarColours(),
    font: { family: getComputedStyle(document.body).fontFamily, size: 13, color: text },
    legend: { x: 0, y: 1, orientation: "h", bgcolor: "rgba(0,0,0,0)" },
    hoverlabel: { bgcolor: cssColour("--card"), bordercolor: line, font: { color: cssColour("--text") } },
  };
}

async function redrawPath() {
  await Plotly.react(pathView.plot, pathTraces(), pathLayout(), plotConfig("path"));
  if (timeView.cursor_s !== null) showOnPath(timeView.cursor_s);
}

/* ---- the cursor ---- */

/* Where the tool was: between the two points of the trail about that time. */
function findOnPath(time_s) {
  const { path } = pathView;
  const cycle = time_s / runData.cycle_s;
  let [low, high] = [0, path.count - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (path.cycle[middle] <= cycle) low = middle;
    else high = middle;
  }
  const share = high > low ? Math.min(1, Math.max(0, (cycle - path.cycle[low]) / (path.cycle[high] - path.cycle[low]))) : 0;
  const mix = (column) => column[low] + share * (column[high] - column[low]);
  return { line: path.line[high], feed: mix(path.feed), at: pathColumns.map((axis) => mix(path[axis])) };
}

function showOnPath(time_s) {
  const found = findOnPath(time_s);
  const position = pathColumns.map((axis, i) => `${axis} ${found.at[i].toFixed(3)}`).join("  ").replaceAll("-", "−");
  document.getElementById("readout").textContent =
    `${time_s.toFixed(3)} s · line ${found.line} · ${position} · ${formatNumber(found.feed, 4)} mm/min`;
  moveMark(found.at);
}

/*
 * Inside the plotting library: known of the very release that is built in, and checked by the browser test. It has no
 * glplot in a browser without WebGL, where the library writes that in place of the path.
 */
function pathScene() {
  return pathView.plot._fullLayout.scene._scene;
}

/* Paper does not wait for the next frame of the scene: a picture of it is printed instead. */
function picturePath() {
  const { container, glplot } = pathScene();
  if (!glplot) return;
  const picture = container.querySelector("img") || container.appendChild(element("img", { class: "on-paper", alt: "" }));
  picture.src = pathScene().toImage("png");
}

/* Moves the mark alone: Plotly.restyle would work through the whole path again. */
function moveMark(at) {
  const scene = pathScene();
  if (!scene.glplot) return;
  const mark = pathView.plot._fullData[markIndex];
  [mark.x, mark.y, mark.z] = at.map((coordinate) => [coordinate]);
  scene.traces[mark.uid].update(mark);
  scene.glplot.redraw();
}

/* ---- controls ---- */

function zoomPath(factor) {
  pathView.zoom *= factor;
  Plotly.relayout(pathView.plot, { "scene.aspectratio": pathAspect() });
}

function lookFrom(name) {
  const { eye, up } = pathEyes[name];
  Plotly.relayout(pathView.plot, { "scene.camera": { eye, up, center: { x: 0, y: 0, z: 0 }, projection: { type: "orthographic" } } });
}

function listenForPath() {
  for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => lookFrom(button.dataset.view));
  for (const button of document.querySelectorAll("[data-path-zoom]"))
    button.addEventListener("click", () => zoomPath(Number(button.dataset.pathZoom)));
  for (const id of ["path-colour", "path-rapids"]) document.getElementById(id).addEventListener("change", redrawPath);
  pathView.plot.on("plotly_hover", ({ points }) => {
    const data = points[0] && points[0].customdata;
    if (data && points[0].curveNumber < 2) setCursor(data[1]);
  });
}

function describePath() {
  const extents = pathColumns.map((axis) => {
    const column = pathView.path[axis];
    const low = column.reduce((a, b) => Math.min(a, b), Infinity);
    const high = column.reduce((a, b) => Math.max(a, b), -Infinity);
    return `${axis} ${formatNumber(low)} to ${formatNumber(high)}`;
  });
  return `Setpoints before correction, machine coordinates: ${extents.join(", ")} mm. Drawn to within `
    + `${formatNumber(runData.path.error_mm, 2)} mm.`;
}

async function showPath() {
  pathView.path = decodePath();
  pathView.plot = document.getElementById("path-plot");
  pathView.ranges = pathRanges();
  const words = describePath();
  document.getElementById("path-caption").textContent = words;
  pathView.plot.setAttribute("aria-label", `Tool path in space. ${words}`);
  await Plotly.newPlot(pathView.plot, pathTraces(), pathLayout(), plotConfig("path"));
  pathView.plot.dataset.points = `path:${pathView.path.count}`;
  listenForPath();
  timeView.listeners.push(showOnPath);
}
