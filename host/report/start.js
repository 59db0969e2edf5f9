"use strict";
/* Colours of the page, and the order in which everything appears. */

const darkWanted = matchMedia("(prefers-color-scheme: dark)");
let themeChoice = "auto";

function applyTheme(theme) {
  document.documentElement.dataset.theme = theme;
  if (!document.documentElement.dataset.ready || typeof Plotly === "undefined" || runData.cycles === 0) return;
  redrawCharts();
  redrawPath();
}

function chosenTheme() {
  return themeChoice === "auto" ? (darkWanted.matches ? "dark" : "light") : themeChoice;
}

function listenForTheme() {
  const buttons = document.querySelectorAll("[data-theme-choice]");
  for (const button of buttons) {
    button.addEventListener("click", () => {
      themeChoice = button.dataset.themeChoice;
      for (const other of buttons) other.setAttribute("aria-pressed", String(other === button));
      applyTheme(chosenTheme());
    });
  }
  darkWanted.addEventListener("change", () => applyTheme(chosenTheme()));
  for (const [event, printing] of [["beforeprint", true], ["afterprint", false]]) {
    addEventListener(event, () => {
      timeView.printing = printing;
      applyTheme(printing ? "light" : chosenTheme());
      if (printing && pathView.plot) picturePath();
    });
  }
}

function leaveOutPlots(reason) {
  for (const id of ["path-section", "charts"]) document.getElementById(id).hidden = true;
  document.getElementById("problems").append(element("p", { class: "note warn" }, reason));
}

async function start() {
  applyTheme(chosenTheme());
  listenForTheme();
  showSummary();
  showMap();
  showShares();
  if (typeof Plotly === "undefined") {
    leaveOutPlots("Plots are missing: the takt that wrote this report was built without the plotting library. Configure "
      + "its build with -DTAKT_PLOTLY_TARBALL=FILE (host/report/README.md says which) and run it again.");
  } else if (runData.cycles === 0) {
    leaveOutPlots("No program cycle ran: there is nothing to plot.");
  } else {
    document.getElementById("credit").hidden = false;
    await showPath();
    await showCharts();
  }
  document.documentElement.dataset.resources = String(performance.getEntriesByType("resource").length);
  document.documentElement.dataset.ready = "true";
}

start();
