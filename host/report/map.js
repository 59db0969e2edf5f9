"use strict";
/* Error of the tool's point over the working volume, before and after correction: pictures of a few levels, as SVG. */

const mapSize_px = 300;
/* Light to dark; told apart without red against green. */
const mapColours = ["#f4f1de", "#f2cc8f", "#e9a15b", "#d8703f", "#b1402f", "#7a1f2b", "#3d0c21"];

function svg(tag, attributes, ...children) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

function mapColour(value, most) {
  const share = most > 0 ? Math.min(1, value / most) : 0;
  return mapColours[Math.min(mapColours.length - 1, Math.floor(share * mapColours.length))];
}

/* One level: a cell for each point, an arrow for its error across X and Y. */
function mapPicture(map, errors, level, most) {
  const [nx, ny] = [map.x.length, map.y.length];
  const height = Math.round((mapSize_px * ny) / nx);
  const [w, h] = [mapSize_px / nx, height / ny];
  const picture = svg("svg", { viewBox: `0 0 ${mapSize_px} ${height}`, width: mapSize_px, height, role: "img", class: "map" });
  for (let j = 0; j < ny; j++) {
    for (let i = 0; i < nx; i++) {
      const [ex, ey, ez] = errors[(level * ny + j) * nx + i];
      const size = Math.hypot(ex, ey, ez);
      const place = `X ${map.x[i]} Y ${map.y[j]} Z ${map.z[level]} mm`;
      const cell = svg("rect", { x: i * w, y: (ny - 1 - j) * h, width: w + 0.5, height: h + 0.5, fill: mapColour(size, most) },
        svg("title", {}, `${place}: ${formatNumber(size, 3)} µm (${[ex, ey, ez].map((e) => formatNumber(e, 3)).join(", ")})`));
      const [cx, cy] = [(i + 0.5) * w, (ny - 0.5 - j) * h];
      const scale = most > 0 ? (0.9 * Math.min(w, h)) / most : 0;
      picture.append(cell, svg("line", { x1: cx, y1: cy, x2: cx + ex * scale, y2: cy - ey * scale, stroke: "#1f6feb", "stroke-width": 1.2 }));
    }
  }
  return picture;
}

function mapLegend(most) {
  const items = mapColours.map((colour, i) => element("span", { class: "map-step" },
    element("span", { class: "swatch", style: `background:${colour}` }), ` ${formatNumber((most * i) / mapColours.length, 2)}`));
  return element("p", { class: "map-legend" }, ...items, ` to ${formatNumber(most, 3)} µm`);
}

function mapRow(map, name, errors) {
  const sizes = errors.map((error) => Math.hypot(...error));
  const most = Math.max(...sizes);
  const mean = sizes.reduce((sum, size) => sum + size, 0) / sizes.length;
  const figure = element("figure", { class: "card" },
    element("h3", {}, name, " ", element("small", {}, `at most ${formatNumber(most, 3)} µm, ${formatNumber(mean, 3)} µm in the mean`)));
  const pictures = element("div", { class: "maps" });
  map.z.forEach((z, level) => pictures.append(element("div", {}, mapPicture(map, errors, level, most), element("p", {}, `Z ${z} mm`))));
  figure.append(pictures, mapLegend(most));
  return figure;
}

function showMap() {
  const map = parseJson("run-map");
  if (map === null) return;
  const section = document.getElementById("map-section");
  section.hidden = false;
  section.append(mapRow(map, "Without correction", map.before), mapRow(map, "With correction", map.after));
}
