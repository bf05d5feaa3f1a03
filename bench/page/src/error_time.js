// SPDX-License-Identifier: MIT
import { addChart } from "./chart.js";
import { legend } from "./legend.js";
import { budgetLimits } from "./limits.js";
import { firstOfKinds, kindOf, median, quantile } from "./numbers.js";

/**
 * Medians over the samples, rung by rung, with the spread from the 10th to the 90th percentile. A solver that is done
 * takes no longer with more effort: less effort that took as long says nothing.
 */
function lineOf(solver, style) {
  const line = { style, x: [], y: [], ringed: [], spread: { low: [], high: [] } };
  const rungs = Math.max(0, ...solver.curves.map((curve) => curve.length));
  for (let rung = 0; rung < rungs; ++rung) {
    const points = solver.curves.filter((curve) => rung < curve.length).map((curve) => curve[rung]);
    const x = median(points.map((p) => p[0]));
    const errors = points.map((p) => Math.max(p[1] ?? 0, 1e-12));
    if (x === null) continue;
    while (line.x.length && line.x.at(-1) >= x) {
      [line.x, line.y, line.ringed, line.spread.low, line.spread.high].forEach((values) => values.pop());
    }
    line.x.push(x);
    line.y.push(median(errors));
    line.ringed.push(median(points.map((p) => p[3])) > 0);
    line.spread.low.push(quantile(errors, 0.1));
    line.spread.high.push(quantile(errors, 0.9));
  }
  return line;
}

export function errorTime(host, scene, page) {
  const kinds = firstOfKinds(scene.solvers).filter((i) => scene.solvers[i].curves.some((c) => c.length));
  const lines = kinds.map((i) => lineOf(scene.solvers[i], i));
  addChart(host, {
    title: "Velocity error against solver time", height: 360, lines,
    note: "Medians over the states; thin lines reach from the 10th to the 90th percentile. A ring: with factorisations.",
    x: { log: true, label: "solver time [ms]" },
    y: { log: true, decades: 7, label: "velocity error [m/s]" },
    limits: budgetLimits(page, "x"),
  });
  host.append(legend(host, kinds, kinds.map((i) => kindOf(scene.solvers[i].label))));
}
