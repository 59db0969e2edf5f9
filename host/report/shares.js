"use strict";
/* Share of the time at each limit, planned on board beside planned ahead: bars, as SVG. */

const shareSize_px = { name: 110, bar: 420, row: 22, gap: 14 };
/* Told apart by lightness too. */
const sharePlanners = [
  { key: "board", name: "on board", colour: "#e9a15b" },
  { key: "ahead", name: "ahead", colour: "#1f6feb" },
];

function shareBar(y, planner, share) {
  const text = `${formatNumber(100 * share, 3)} %`;
  const x = shareSize_px.name;
  return [
    svg("rect", { x, y, width: Math.max(1, share * shareSize_px.bar), height: shareSize_px.row - 4, fill: planner.colour },
      svg("title", {}, `${planner.name}: ${text}`)),
    svg("text", { x: x + share * shareSize_px.bar + 6, y: y + shareSize_px.row - 8, class: "share-text" }, text),
  ];
}

function sharePicture(shares) {
  const kinds = ["velocity", "acceleration", "jerk"];
  const group = sharePlanners.length * shareSize_px.row + shareSize_px.gap;
  const [width, height] = [shareSize_px.name + shareSize_px.bar + 80, kinds.length * group];
  const picture = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", class: "map", "aria-label": "Share of the time at each limit" });
  kinds.forEach((kind, i) => {
    picture.append(svg("text", { x: 0, y: i * group + shareSize_px.row, class: "share-text" }, kind));
    sharePlanners.forEach((planner, k) => picture.append(...shareBar(i * group + k * shareSize_px.row, planner, shares[planner.key][kind])));
  });
  return picture;
}

function shareLegend(shares) {
  const items = sharePlanners.map((planner) => element("span", { class: "map-step" },
    element("span", { class: "swatch", style: `background:${planner.colour}` }), ` ${planner.name}, ${shares[planner.key].time_s.toFixed(3)} s`));
  return element("p", { class: "map-legend" }, ...items);
}

function showShares() {
  const shares = parseJson("run-shares");
  if (shares === null) return;
  const section = document.getElementById("shares-section");
  section.hidden = false;
  section.append(element("figure", { class: "card" }, sharePicture(shares), shareLegend(shares)));
}
