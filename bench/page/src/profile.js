// SPDX-License-Identifier: MIT
// Performance profiles after Dolan and More.
import { addChart } from "./chart.js";
import { element } from "./element.js";
import { legend } from "./legend.js";
import { firstOfKinds, kindOf } from "./numbers.js";

const TARGETS = [1e-1, 1e-2, 1e-3];
const FURTHEST = 100;

/** The least time in which a curve got to an error; infinity if it did not. */
function timeTo(curve, target) {
  const there = curve.filter((p) => p[1] !== null && p[1] <= target).map((p) => p[0]);
  return there.length ? Math.min(...there) : Infinity;
}

/** Ratios to the quickest solver, state by state; states that nobody solved are left out. */
function ratios(solvers, target) {
  const states = solvers[0].curves.length;
  const found = solvers.map(() => []);
  let solved = 0;
  for (let state = 0; state < states; ++state) {
    const times = solvers.map((solver) => timeTo(solver.curves[state] ?? [], target));
    const least = Math.min(...times);
    if (!Number.isFinite(least)) continue;
    ++solved;
    times.forEach((time, s) => found[s].push(time / least));
  }
  return { found, solved, states };
}

function lineOf(found, solved, style) {
  const sorted = found.filter((r) => r <= FURTHEST).sort((a, b) => a - b);
  const line = { style, stepped: true, x: [], y: [] };
  sorted.forEach((ratio, i) => {
    if (line.x.at(-1) === ratio) line.y[line.y.length - 1] = (i + 1) / solved;
    else line.x.push(ratio), line.y.push((i + 1) / solved);
  });
  if (line.x.length === 0) return line;
  line.x.push(FURTHEST);
  line.y.push(line.y.at(-1));
  return line;
}

export function profile(host, scene) {
  const kinds = firstOfKinds(scene.solvers).filter((i) => scene.solvers[i].curves.length);
  if (kinds.length === 0) return;
  const grid = element("div", { className: "plots" });
  host.append(grid);
  for (const target of TARGETS) {
    const { found, solved, states } = ratios(kinds.map((i) => scene.solvers[i]), target);
    const title = `Time to a velocity error of ${target} m/s`;
    if (solved === 0) {
      grid.append(element("figure", {}, element("div", { className: "plot-title", textContent: title }),
        element("p", { className: "soft", textContent: "No solver got there on any state, with what it was given." })));
      continue;
    }
    addChart(grid, {
      title, height: 220, lines: kinds.map((i, k) => lineOf(found[k], solved, i)),
      note: `${solved} of ${states} states: those that any solver brought there.`,
      x: { log: true, low: 1, high: FURTHEST, label: "time, as a multiple of the quickest solver's" },
      y: { low: 0, high: 1.05, label: "share of states" },
    });
  }
  host.append(legend(host, kinds, kinds.map((i) => kindOf(scene.solvers[i].label))));
}
