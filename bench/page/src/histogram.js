// SPDX-License-Identifier: MIT
import { addChart } from "./chart.js";
import { element } from "./element.js";
import { legend } from "./legend.js";
import { budgetLimits } from "./limits.js";

const BINS_PER_DECADE = 20;

function timed(solver, scene) {
  const untimed = new Set(scene.untimed);
  return solver.time.filter((t, i) => t !== null && t > 0 && !untimed.has(i));
}

function histogramLine(times, style) {
  const counts = new Map();
  for (const time of times) {
    const bin = Math.floor(Math.log10(time) * BINS_PER_DECADE);
    counts.set(bin, (counts.get(bin) ?? 0) + 1);
  }
  const line = { style, stepped: true, x: [], y: [], markers: false };
  const bins = [...counts.keys()].sort((a, b) => a - b);
  if (bins.length === 0) return line;
  for (let bin = bins[0] - 1; bin <= bins.at(-1) + 1; ++bin) {
    line.x.push(10 ** (bin / BINS_PER_DECADE));
    line.y.push(counts.get(bin) ?? 0.5);
  }
  return line;
}

/** The share of frames that took longer than x. */
function tailLine(times, style) {
  const sorted = [...times].sort((a, b) => a - b);
  const line = { style, stepped: true, x: [], y: [] };
  sorted.forEach((time, i) => {
    const share = (sorted.length - i) / sorted.length;
    if (line.x.at(-1) !== time) line.x.push(time), line.y.push(share);
  });
  return line;
}

export function histogram(host, scene, page) {
  const grid = element("div", { className: "plots" });
  host.append(grid);
  const times = scene.solvers.map((solver) => timed(solver, scene));
  addChart(grid, {
    title: "Histogram of frame times", lines: times.map(histogramLine),
    x: { log: true, label: "time in the solver [ms]" }, y: { log: true, low: 0.7, label: "frames" },
    limits: budgetLimits(page, "x"),
  });
  addChart(grid, {
    title: "The tail: share of frames that took longer", lines: times.map(tailLine),
    x: { log: true, label: "time in the solver [ms]" },
    y: { log: true, high: 2.5, label: "share of frames", format: (v) => (v > 1 ? "" : `${Number((100 * v).toPrecision(2))} %`) },
    limits: budgetLimits(page, "x"),
  });
  host.append(legend(host, scene.solvers.map((_, i) => i)));
}
