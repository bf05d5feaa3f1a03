// SPDX-License-Identifier: MIT
// Performance profiles after Dolan and More.
import { addChart } from "./chart.js";
import { element } from "./element.js";
import { legend } from "./legend.js";
import { firstOfKinds, kindOf } from "./numbers.js";

const TARGETS = [1, 0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4, 1e-5];
const MOST_PICTURES = 3;
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

/** The hardest targets that any solver reached on half of the states; the easiest if none was. */
function targetsOf(solvers) {
  const reached = TARGETS.filter((target) => {
    const { solved, states } = ratios(solvers, target);
    return solved > 0 && 2 * solved >= states;
  });
  return reached.length ? reached.slice(-MOST_PICTURES) : TARGETS.filter((t) => ratios(solvers, t).solved > 0).slice(0, 1);
}

export function profile(host, scene) {
  const kinds = firstOfKinds(scene.solvers).filter((i) => scene.solvers[i].curves.some((c) => c.length));
  const solvers = kinds.map((i) => scene.solvers[i]);
  const targets = kinds.length ? targetsOf(solvers) : [];
  if (targets.length === 0) {
    host.append(element("p", { className: "soft", textContent: `No solver got below ${TARGETS[0]} m/s on any state.` }));
    return;
  }
  const grid = element("div", { className: "plots" });
  host.append(grid);
  for (const target of targets) {
    const { found, solved, states } = ratios(solvers, target);
    addChart(grid, {
      title: `Time to a velocity error of ${target} m/s`, height: 220,
      lines: kinds.map((i, k) => lineOf(found[k], solved, i)),
      note: `${solved} of ${states} states: those that any solver brought there.`,
      x: { log: true, low: 1, high: FURTHEST, label: "time, as a multiple of the quickest solver's" },
      y: { low: 0, high: 1.05, label: "share of states" },
    });
  }
  host.append(legend(host, kinds, kinds.map((i) => kindOf(scene.solvers[i].label))));
}
